// Locks that keep programs from writing the same results; the system releases them when a process ends, however it
// ends.
#pragma once

#include <filesystem>
#include <string>

namespace springproof {

/// Locks a folder during its lifetime, on this machine; no file is left behind.
class FolderLock {
 public:
  enum Use { alone, beside_shards };
  /// @throws InputError if another process holds the folder, or holds it alone.
  explicit FolderLock(const std::filesystem::path& folder, Use use = alone);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Locks one byte of a file, or all, during its lifetime; on a network file system also against other machines, where
/// it has locks.  None is taken where there are no locks, or no such file.
class ByteLock {
 public:
  static constexpr int all = -1;
  /// @throws InputError with the text `refusal` if another process holds it.
  ByteLock(const std::filesystem::path& file, int byte, const std::string& refusal);
  ~ByteLock();
  ByteLock(const ByteLock&) = delete;
  ByteLock& operator=(const ByteLock&) = delete;

 private:
  int descriptor_;
};

/// Whether another process holds the byte.
bool is_locked(const std::filesystem::path& file, int byte);

}  // namespace springproof
