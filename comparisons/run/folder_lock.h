// One comparison at a time in a folder.
#pragma once

#include <filesystem>

namespace springproof {

/// Holds a folder as long as it lives; the system lets go of it when the process ends, however it ends, and nothing is
/// left behind.
class FolderLock {
 public:
  /// @throws InputError if another process holds the folder.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace springproof
