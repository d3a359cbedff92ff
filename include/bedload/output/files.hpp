#pragma once
// Files that are either complete or absent.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace bedload {

/// Text of a whole file. Throws FileError.
std::string read_file(const std::filesystem::path& path);

/// The text of the file `name` without a leading byte order mark, as some spreadsheets and editors write.
/// Throws FileError for UTF-16.
std::string_view without_mark(std::string_view text, const std::string& name);

/// Text of a whole file without that mark. Throws FileError.
std::string read_text(const std::filesystem::path& path);

/// Replaces a file atomically: writes a temporary file and renames it. Not synced, unlike commit_file. Throws
/// FileError.
void write_file(const std::filesystem::path& path, const std::string& text);

/// Syncs the finished file `part` and renames it to `path`. Throws FileError.
void commit_file(const std::filesystem::path& part, const std::filesystem::path& path);

/// Appends a seal: "BEDLOAD", a new line and a checksum of the content. Throws FileError.
void seal_file(const std::filesystem::path& path);

enum class Seal { whole, missing, broken };
/// Whether a file ends with a seal that matches its content.
Seal seal_of(const std::filesystem::path& path);

/// Name of the temporary file for `path`.
std::filesystem::path part_of(const std::filesystem::path& path);

/// Throws FileError unless the disk of `path` has space for `bytes` more. An existing file reserves the space
/// until free_reserve.
void need_space(const std::filesystem::path& path, std::size_t bytes);

/// Releases the space reserved by need_space that the file did not use.
void free_reserve(const std::filesystem::path& path);

/// Throws FileError if `path` is a folder where a file is to be written.
void must_be_no_folder(const std::filesystem::path& path);

/// Throws FileError unless `path` does not exist or is a readable and writable file or folder, as given by
/// `type`, or a link to one.
void must_be_usable(const std::filesystem::path& path, std::filesystem::file_type type);

/// Removes a file if it exists. Throws FileError.
void remove_file(const std::filesystem::path& path);

/// Throws FileError if a file written before is gone.
void must_be_there(const std::filesystem::path& path);

}  // namespace bedload
