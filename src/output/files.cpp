#include "bedload/output/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

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

/// Reserves disk space beyond the end of a file; false if there is no file or the file system cannot.
bool reserved(const std::filesystem::path& path, std::size_t bytes) {
  const int file = ::open(path.c_str(), O_WRONLY);
  if (file < 0) return false;
  const off_t end = ::lseek(file, 0, SEEK_END);
  rlimit most{};
  const bool allowed = ::getrlimit(RLIMIT_FSIZE, &most) != 0 || std::size_t(end) + bytes <= most.rlim_cur;
  const bool done = allowed && ::fallocate(file, FALLOC_FL_KEEP_SIZE, end, off_t(bytes)) == 0;
  const int reason = allowed ? errno : EFBIG;
  ::close(file);
  errno = reason;
  if (!done && (errno == ENOSPC || errno == EDQUOT || errno == EFBIG)) throw cannot("write", path);
  return done;
}

constexpr std::array<char, 8> kSeal{'B', 'E', 'D', 'L', 'O', 'A', 'D', '\n'};

/// FNV-1a over 8-byte words of the first `length` bytes; a changed bit changes it.
std::uint64_t checksum(std::istream& in, std::uintmax_t length) {
  std::uint64_t sum = 0xcbf29ce484222325u;
  std::vector<std::uint64_t> words(1 << 17);
  while (length > 0) {
    const auto bytes = std::min<std::uintmax_t>(length, 8 * words.size());
    const auto count = std::size_t((bytes + 7) / 8);
    words[count - 1] = 0;
    in.read(reinterpret_cast<char*>(words.data()), std::streamsize(bytes));
    for (std::size_t k = 0; k < count; ++k) {
      sum = (sum ^ words[k]) * 0x100000001b3u;
      sum ^= sum >> 32;
    }
    length -= bytes;
  }
  return sum;
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw cannot("read", path);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string_view without_mark(std::string_view text, const std::string& name) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw FileError(name + ": is in UTF-16; save it as UTF-8");
  return text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0);
}

std::string read_text(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  return std::string(without_mark(text, path.string()));
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
  if (reserved(path, bytes)) return;
  std::error_code unknown;
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const auto space = std::filesystem::space(folder, unknown);
  if (unknown || space.available >= bytes) return;
  throw FileError(fmt::format("{}: cannot write: disk full: {:.1f} MB left, {:.1f} MB needed", path.string(),
                              space.available * 1e-6, bytes * 1e-6));
}

void free_reserve(const std::filesystem::path& path) {
  std::error_code none;
  const auto size = std::filesystem::file_size(path, none);
  if (!none) std::filesystem::resize_file(path, size, none);
}

void must_be_no_folder(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(std::filesystem::symlink_status(path)))
    throw FileError(path.string() + ": cannot write: it is a folder");
}

void must_be_usable(const std::filesystem::path& path, std::filesystem::file_type type) {
  std::error_code unknown;
  const auto found = std::filesystem::status(path, unknown).type();
  if (found == std::filesystem::file_type::not_found) {
    if (!std::filesystem::is_symlink(path)) return;
    throw FileError(path.string() + ": cannot write: it is a broken link");
  }
  if (found != type) {
    const bool folder = found == std::filesystem::file_type::directory;
    throw FileError(path.string() + ": cannot write: it is " +
                    (folder                                          ? "a folder"
                     : type == std::filesystem::file_type::directory ? "not a folder"
                                                                     : "not a file"));
  }
  if (::access(path.c_str(), R_OK | W_OK) != 0) throw cannot("write", path);
}

void remove_file(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) throw FileError(fmt::format("{}: cannot remove: {}", path.string(), error.message()));
}

void must_be_there(const std::filesystem::path& path) {
  std::error_code unknown;
  if (std::filesystem::exists(path, unknown) || unknown) return;
  throw FileError(path.string() + ": cannot write: it was removed during the run");
}

void seal_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::uint64_t sum = checksum(in, std::filesystem::file_size(path));
  std::ofstream out(path, std::ios::binary | std::ios::app);
  out.write(kSeal.data(), kSeal.size());
  out.write(reinterpret_cast<const char*>(&sum), sizeof sum);
  out.close();
  if (!in || !out) throw cannot("write", path);
}

Seal seal_of(const std::filesystem::path& path) {
  constexpr std::uintmax_t tail = kSeal.size() + sizeof(std::uint64_t);
  const std::uintmax_t size = std::filesystem::file_size(path);
  if (size < tail) return Seal::missing;
  std::ifstream in(path, std::ios::binary);
  const std::uint64_t sum = checksum(in, size - tail);
  std::array<char, 8> seal{};
  std::uint64_t found = 0;
  in.read(seal.data(), seal.size());
  in.read(reinterpret_cast<char*>(&found), sizeof found);
  if (!in || seal != kSeal) return Seal::missing;
  return sum == found ? Seal::whole : Seal::broken;
}

}  // namespace bedload
