#include "comparisons/sweep/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "problem/system/input_error.h"

namespace springproof {
namespace {

/// Of the process' open file, not of the process: a second lock in one process conflicts, and nothing else closes it.
struct flock of_bytes(int byte) {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte == ByteLock::all ? 0 : byte;
  lock.l_len = byte == ByteLock::all ? 0 : 1;
  return lock;
}

}  // namespace

// On a file system without file locks none is taken.
FolderLock::FolderLock(const std::filesystem::path& folder, Use use)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  const int kind = use == alone ? LOCK_EX : LOCK_SH;
  if (descriptor_ < 0 || flock(descriptor_, kind | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(descriptor_);
  throw InputError(fmt::format("--out: {} is in use by another springproof (wait for its end, or name another folder)",
                               folder.string()));
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

ByteLock::ByteLock(const std::filesystem::path& file, int byte, const std::string& refusal)
    : descriptor_(open(file.c_str(), O_RDWR | O_CLOEXEC)) {
  struct flock lock = of_bytes(byte);
  if (descriptor_ < 0 || fcntl(descriptor_, F_OFD_SETLK, &lock) == 0 || (errno != EAGAIN && errno != EACCES)) return;
  close(descriptor_);
  throw InputError(refusal);
}

ByteLock::~ByteLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool is_locked(const std::filesystem::path& file, int byte) {
  const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC);
  struct flock lock = of_bytes(byte);
  const bool known = descriptor >= 0 && fcntl(descriptor, F_OFD_GETLK, &lock) == 0;
  if (descriptor >= 0) close(descriptor);
  return known && lock.l_type != F_UNLCK;
}

}  // namespace springproof
