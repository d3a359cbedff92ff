#include "bedload/output/h5.hpp"

namespace bedload::h5 {
namespace {

herr_t keep_last(unsigned, const H5E_error2_t* entry, void* text) {
  *static_cast<std::string*>(text) = entry->desc ? entry->desc : "";
  return 0;
}

/// Errors are thrown, not printed (a setting per thread). The cleanup at exit is off: it crashes on files
/// that a failed write left open, and all others are closed by then.
void set_up_library() {
  static const bool first = H5dont_atexit() >= 0;
  if (!first || H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) < 0)
    throw Error("cannot initialise the HDF5 library");
}

Handle property_list(hid_t kind) { return Handle(H5Pcreate(kind)); }

/// Sets a scalar attribute, new or not.
void put(hid_t object, const char* attribute, hid_t stored, hid_t in_memory, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR));
  if (has_attribute(object, attribute)) check(H5Adelete(object, attribute));
  const Handle a(H5Acreate2(object, attribute, stored, space, H5P_DEFAULT, H5P_DEFAULT));
  check(H5Awrite(a, in_memory, value));
}

/// An attribute with a single value.
Handle get(hid_t object, const char* attribute) {
  Handle a(H5Aopen(object, attribute, H5P_DEFAULT));
  if (H5Sget_simple_extent_npoints(Handle(H5Aget_space(a))) != 1)
    throw Error("attribute '" + std::string(attribute) + "' must hold one value");
  return a;
}

}  // namespace

std::string reason() {
  std::string text;  // the walk ends at the innermost call, which knows the cause
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_last, &text);
  const std::string key = "error message = '";
  if (const auto at = text.find(key); at != std::string::npos) {
    const auto start = at + key.size();
    return text.substr(start, text.find('\'', start) - start);
  }
  return text.empty() ? "HDF5 error" : text;
}

bool is_hdf5(const std::filesystem::path& path) {
  set_up_library();
  return H5Fis_hdf5(path.c_str()) > 0;
}

Handle open_file(const std::filesystem::path& path, Mode mode) {
  set_up_library();
  const Handle access = property_list(H5P_FILE_ACCESS);
  check(H5Pset_file_locking(access, false, true));
  if (mode != Mode::create)
    return Handle(H5Fopen(path.c_str(), mode == Mode::read ? H5F_ACC_RDONLY : H5F_ACC_RDWR, access));
  const Handle creation = property_list(H5P_FILE_CREATE);
  check(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  check(H5Pset_obj_track_times(creation, false));
  return Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access));
}

Handle create_group(hid_t parent, const std::string& name) {
  const Handle creation = property_list(H5P_GROUP_CREATE);
  check(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  check(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  check(H5Pset_obj_track_times(creation, false));
  return Handle(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT));
}

Handle open_group(hid_t parent, const std::string& name) {
  return Handle(H5Gopen2(parent, name.c_str(), H5P_DEFAULT));
}

bool has_member(hid_t group, const char* name) { return check(H5Lexists(group, name, H5P_DEFAULT)) > 0; }

std::vector<std::string> members(hid_t group) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->push_back(name);
    return 0;
  };
  check(H5Literate(group, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, add, &names));
  return names;
}

hid_t file_type(Scalar type) {
  switch (type) {
    case Scalar::f32:
      return H5T_IEEE_F32LE;
    case Scalar::f64:
      return H5T_IEEE_F64LE;
    case Scalar::u32:
      return H5T_STD_U32LE;
    case Scalar::u64:
      return H5T_STD_U64LE;
  }
  throw Error("unknown number type");
}

hid_t memory_type(Scalar type) {
  switch (type) {
    case Scalar::f32:
      return H5T_NATIVE_FLOAT;
    case Scalar::f64:
      return H5T_NATIVE_DOUBLE;
    case Scalar::u32:
      return H5T_NATIVE_UINT32;
    case Scalar::u64:
      return H5T_NATIVE_UINT64;
  }
  throw Error("unknown number type");
}

Scalar scalar_of(hid_t dataset) {
  const Handle type(H5Dget_type(dataset));
  const bool real = H5Tget_class(type) == H5T_FLOAT;
  if (H5Tget_size(type) == 4) return real ? Scalar::f32 : Scalar::u32;
  if (H5Tget_size(type) == 8) return real ? Scalar::f64 : Scalar::u64;
  throw Error("an array has an unknown number type");
}

std::vector<hsize_t> extent(hid_t dataset) {
  const Handle space(H5Dget_space(dataset));
  std::vector<hsize_t> n(check(H5Sget_simple_extent_ndims(space)));
  if (!n.empty()) check(H5Sget_simple_extent_dims(space, n.data(), nullptr));
  return n;
}

std::vector<hsize_t> stored_extent(hid_t dataset) {
  constexpr double kMostDeflated = 1032;  // times, by zlib
  const auto n = extent(dataset);
  double bytes = double(H5Tget_size(Handle(H5Dget_type(dataset))));
  for (const hsize_t length : n) bytes *= double(length);
  if (bytes > kMostDeflated * double(H5Dget_storage_size(dataset)))
    throw Error("an array is larger than its stored data");
  return n;
}

void write_text(hid_t object, const char* attribute, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1));
  check(H5Tset_size(type, text.empty() ? 1 : text.size()));
  check(H5Tset_strpad(type, H5T_STR_NULLPAD));
  put(object, attribute, type, type, text.c_str());
}

std::string read_text(hid_t object, const char* attribute) {
  const Handle a = get(object, attribute);
  const Handle type(H5Aget_type(a));
  if (H5Tget_class(type) != H5T_STRING) throw Error("attribute '" + std::string(attribute) + "' is not text");
  if (check(H5Tis_variable_str(type)) > 0) {
    char* value = nullptr;
    check(H5Aread(a, type, &value));
    const std::string text = value ? value : "";
    H5free_memory(value);
    return text;
  }
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(a, type, text.data()));
  text.resize(text.find_last_not_of('\0') + 1);
  return text;
}

void write_number(hid_t object, const char* attribute, double value) {
  put(object, attribute, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

double read_number(hid_t object, const char* attribute) {
  double value = 0;
  check(H5Aread(get(object, attribute), H5T_NATIVE_DOUBLE, &value));
  return value;
}

void write_integer(hid_t object, const char* attribute, std::int64_t value) {
  put(object, attribute, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

std::int64_t read_integer(hid_t object, const char* attribute) {
  std::int64_t value = 0;
  check(H5Aread(get(object, attribute), H5T_NATIVE_INT64, &value));
  return value;
}

bool has_attribute(hid_t object, const char* attribute) { return check(H5Aexists(object, attribute)) > 0; }

std::vector<std::string> attributes(hid_t group) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->push_back(name);
    return 0;
  };
  check(H5Aiterate2(group, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, add, &names));
  return names;
}

}  // namespace bedload::h5
