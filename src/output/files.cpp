#include "bedload/output/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include "bedload/core/error.hpp"

namespace bedload {
namespace {

FileError cannot(const char* verb, const std::filesystem::path& path) {
  return FileError(fmt::format("{}: cannot {}: {}", path.string(), verb, std::strerror(errno)));
}

void sync(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY);
  if (file < 0) throw cannot("open", path);
  const bool done = ::fsync(file) == 0 || errno == EINVAL;  // some file systems cannot sync a folder
  ::close(file);
  if (!done) throw cannot("write", path);
}

void move(const std::filesystem::path& part, const std::filesystem::path& path) {
  if (std::rename(part.c_str(), path.c_str()) != 0) throw cannot("write", path);
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw cannot("read", path);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::filesystem::path part_of(const std::filesystem::path& path) { return path.string() + ".part"; }

void commit_file(const std::filesystem::path& part, const std::filesystem::path& path) {
  sync(part);
  move(part, path);
  sync(path.has_parent_path() ? path.parent_path() : ".");
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  const auto part = part_of(path);
  std::FILE* file = std::fopen(part.c_str(), "wb");
  if (!file) throw cannot("write", path);
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const int reason = errno;
  const bool closed = std::fclose(file) == 0;
  if (!written || !closed) {
    if (!written) errno = reason;
    const auto error = cannot("write", path);
    std::remove(part.c_str());
    throw error;
  }
  move(part, path);
}

void need_space(const std::filesystem::path& path, std::size_t bytes) {
  std::error_code unknown;
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const auto space = std::filesystem::space(folder, unknown);
  if (unknown || space.available >= bytes) return;
  throw FileError(fmt::format("{}: cannot write: the disk has {:.1f} MB left and {:.1f} MB are needed",
                              path.string(), space.available * 1e-6, bytes * 1e-6));
}

}  // namespace bedload
