#pragma once
// Files that are either whole or not there.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace bedload {

/// Text of a whole file. Throws FileError.
std::string read_file(const std::filesystem::path& path);

/// What lies behind the byte order mark that spreadsheets and editors put first in the text of the file
/// `name`. Throws FileError for UTF-16.
std::string_view without_mark(std::string_view text, const std::string& name);

/// The text of a whole file without that mark. Throws FileError.
std::string read_text(const std::filesystem::path& path);

/// Replaces a file in one go: written beside its place, then renamed; survives a kill
/// but is not synced, unlike commit_file. Throws FileError.
void write_file(const std::filesystem::path& path, const std::string& text);

/// Puts the finished file `part` in the place of `path`, surely on disk. Throws FileError.
void commit_file(const std::filesystem::path& part, const std::filesystem::path& path);

/// Puts a seal behind the content of a file: "BEDLOAD", a new line and a checksum of all before. Throws
/// FileError.
void seal_file(const std::filesystem::path& path);

enum class Seal { whole, missing, broken };
/// Whether a file ends with a seal that fits what lies before.
Seal seal_of(const std::filesystem::path& path);

/// Name of the unfinished file beside `path`.
std::filesystem::path part_of(const std::filesystem::path& path);

/// Throws FileError unless the disk that holds `path` has space for `bytes` more. A file that is there keeps
/// the space, even against others that write, until free_reserve.
void need_space(const std::filesystem::path& path, std::size_t bytes);

/// Gives back what need_space took and the file did not grow by.
void free_reserve(const std::filesystem::path& path);

/// Throws FileError if a folder lies where a file is to be written.
void must_be_no_folder(const std::filesystem::path& path);

/// Throws FileError unless there is nothing, or what can be read and written: a file or a folder, as `type`
/// says, or a link to one.
void must_be_usable(const std::filesystem::path& path, std::filesystem::file_type type);

/// Removes a file that may not be there. Throws FileError.
void remove_file(const std::filesystem::path& path);

/// Throws FileError if a file has gone that was written before.
void must_be_there(const std::filesystem::path& path);

}  // namespace bedload
