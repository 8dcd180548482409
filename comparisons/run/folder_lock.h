// File lock that allows one comparison at a time in a folder.
#pragma once

#include <filesystem>

namespace springproof {

/// Locks a folder during its lifetime; the system releases the lock when the process ends, however it ends, and no file
/// is left behind.
class FolderLock {
 public:
  /// @throws InputError if another process holds the lock.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace springproof
