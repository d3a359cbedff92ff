#pragma once
// A thin layer over the HDF5 C library: handles that close themselves, errors
// as exceptions, attributes and types of Bedload's arrays.

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bedload/core/error.hpp"
#include "bedload/host_data.hpp"

namespace bedload::h5 {

/// An HDF5 call failed; the message is the library's innermost reason. Public
/// functions turn it into a FileError that names the file.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Innermost message on the library's error stack, e.g. "No space left on device".
std::string reason();

/// Runs `action` on a file; its errors become FileErrors "<path>: cannot <verb>: <reason>".
template <class Action>
auto with_file_errors(const std::filesystem::path& path, const std::string& verb, Action action) {
  try {
    return action();
  } catch (const Error& e) {
    throw FileError(path.string() + ": cannot " + verb + ": " + e.what());
  } catch (const std::length_error&) {
    throw FileError(path.string() + ": cannot " + verb + ": it claims an array larger than memory");
  }
}

/// Passes a result on unless it means that the call failed.
template <class T>
T check(T result) {
  if (result < 0) throw Error(reason());
  return result;
}

/// Owner of one HDF5 identifier of any kind.
class Handle {
 public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(check(id)) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) H5Idec_ref(id_);
  }
  operator hid_t() const { return id_; }
  /// Closes now, so that an error on the way to disk is not lost.
  void close() { check(H5Idec_ref(std::exchange(id_, -1))); }

 private:
  hid_t id_ = -1;
};

bool is_hdf5(const std::filesystem::path& path);

enum class Mode { create, read, append };
/// Opens a file without locks (viewers may read during a run) and without times.
Handle open_file(const std::filesystem::path& path, Mode mode);

/// Group `name`; a new one remembers the order in which its members came.
Handle create_group(hid_t parent, const std::string& name);
Handle open_group(hid_t parent, const std::string& name);
bool has_member(hid_t group, const char* name);
/// Members of a group in order of creation.
std::vector<std::string> members(hid_t group);

hid_t file_type(Scalar type);  ///< little-endian, as stored
hid_t memory_type(Scalar type);
Scalar scalar_of(hid_t dataset);  ///< type of a stored dataset

/// Extent of a dataset; {} for a single value.
std::vector<hsize_t> extent(hid_t dataset);
/// The same of one that is to be read whole: Error where less is stored than could ever unfold to it.
std::vector<hsize_t> stored_extent(hid_t dataset);

void write_text(hid_t object, const char* attribute, const std::string& text);
std::string read_text(hid_t object, const char* attribute);
void write_number(hid_t object, const char* attribute, double value);
double read_number(hid_t object, const char* attribute);
void write_integer(hid_t object, const char* attribute, std::int64_t value);
std::int64_t read_integer(hid_t object, const char* attribute);
bool has_attribute(hid_t object, const char* attribute);
/// Names of the attributes of a group in order of creation.
std::vector<std::string> attributes(hid_t group);

}  // namespace bedload::h5
