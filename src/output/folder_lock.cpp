#include "bedload/output/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iterator>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

std::string this_process() {
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  return fmt::format("process {} on {}", ::getpid(), host);
}

FileError cannot(const fs::path& folder, int reason) {
  return FileError(fmt::format("{}: cannot write results there: {}", folder.string(), std::strerror(reason)));
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : folder_(folder) {
  const fs::path file = folder / ".lock";
  std::error_code error;
  made_ = fs::create_directories(folder, error);
  if (error) throw cannot(folder, error.value());
  handle_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (handle_ < 0) throw cannot(folder, errno);
  if (::flock(handle_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    const std::string holder = read_file(file);
    ::close(handle_);
    throw FileError(fmt::format("{}: in use by {}; wait for it, stop it or choose another --out",
                                folder.string(), holder.empty() ? "another run" : holder));
  }  // without a lock on file systems that have none
  const std::string text = this_process();
  const bool written = ::ftruncate(handle_, 0) == 0 && ::pwrite(handle_, text.data(), text.size(), 0) > 0;
  if (written) return;
  const int reason = errno;
  ::close(handle_);
  throw cannot(folder, reason);
}

FolderLock::~FolderLock() {
  (void)!::ftruncate(handle_, 0);  // the file stays: a new file would be a different lock
  std::error_code none;
  if (made_ && std::distance(fs::directory_iterator(folder_, none), {}) == 1) fs::remove_all(folder_, none);
  ::close(handle_);
}

}  // namespace bedload
