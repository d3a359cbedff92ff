#pragma once
// A lock on a results folder: one run at a time.

#include <filesystem>

namespace bedload {

/// Locks a folder until destroyed or until the process ends.
class FolderLock {
 public:
  /// Creates the folder and checks that it is writable. Throws FileError; if the folder is in use, it names the
  /// process. A folder that was created here and stays empty is removed again.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  bool made_ = false;
  int handle_ = -1;
};

}  // namespace bedload
