#pragma once
// One run at a time in a results folder.

#include <filesystem>

namespace bedload {

/// Holds a folder for this process until destroyed. The lock dies with the process, however that ends.
class FolderLock {
 public:
  /// Makes the folder and sees that it can be written to. Throws FileError, with who holds it if another
  /// does. A folder that was made and stays empty is removed again.
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
