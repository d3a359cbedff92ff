#include "bedload/output/h5_table.hpp"

#include <algorithm>
#include <cstring>

namespace bedload::h5 {

Handle open_dataset(hid_t parent, const std::string& name) {
  return Handle(H5Dopen2(parent, name.c_str(), H5P_DEFAULT));
}

Handle create_table(hid_t parent, const std::string& name, hid_t type, hsize_t columns, hsize_t chunk_rows,
                    int deflate) {
  const int rank = columns > 1 ? 2 : 1;
  const hsize_t now[2] = {0, columns}, most[2] = {H5S_UNLIMITED, columns}, chunk[2] = {chunk_rows, columns};
  const Handle space(H5Screate_simple(rank, now, most));
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE));
  check(H5Pset_chunk(creation, rank, chunk));
  check(H5Pset_obj_track_times(creation, false));
  if (deflate > 0) check(H5Pset_deflate(creation, deflate));
  return Handle(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
}

void resize(hid_t table, hsize_t rows) {
  auto n = extent(table);
  n.at(0) = rows;
  check(H5Dset_extent(table, n.data()));
}

std::pair<Handle, Handle> rows_of(hid_t table, hsize_t first, hsize_t rows) {
  auto n = extent(table);
  std::vector<hsize_t> start(n.size(), 0);
  start[0] = first;
  n[0] = rows;
  Handle file(H5Dget_space(table));
  if (rows == 0)
    check(H5Sselect_none(file));
  else
    check(H5Sselect_hyperslab(file, H5S_SELECT_SET, start.data(), nullptr, n.data(), nullptr));
  Handle memory(H5Screate_simple(int(n.size()), n.data(), nullptr));
  if (rows == 0) check(H5Sselect_none(memory));
  return {std::move(file), std::move(memory)};
}

void append_rows(hid_t table, hid_t type, const void* data, hsize_t rows) {
  const hsize_t old = extent(table)[0];
  resize(table, old + rows);
  const auto [file, memory] = rows_of(table, old, rows);
  check(H5Dwrite(table, type, memory, file, H5P_DEFAULT, data));
}

void read_rows(hid_t table, hid_t type, hsize_t first, hsize_t rows, void* data) {
  const auto [file, memory] = rows_of(table, first, rows);
  check(H5Dread(table, type, memory, file, H5P_DEFAULT, data));
}

void append_integers(hid_t parent, const std::string& name, const std::vector<std::int64_t>& values,
                     hsize_t rows) {
  append_rows(open_dataset(parent, name), H5T_NATIVE_INT64, values.data(), rows);
}

std::vector<std::int64_t> read_integers(hid_t parent, const std::string& name, hsize_t rows) {
  const Handle table = open_dataset(parent, name);
  std::vector<std::int64_t> values(rows);
  read_rows(table, H5T_NATIVE_INT64, 0, rows, values.data());
  return values;
}

bool rows_equal(hid_t table, Scalar type, hsize_t first, hsize_t rows, const std::byte* data,
                std::size_t row_bytes) {
  std::vector<std::byte> block;
  for (hsize_t done = 0; done < rows;) {
    const hsize_t n = std::min<hsize_t>(rows - done, 4096);
    block.resize(n * row_bytes);
    read_rows(table, memory_type(type), first + done, n, block.data());
    if (std::memcmp(block.data(), data + done * row_bytes, block.size()) != 0) return false;
    done += n;
  }
  return true;
}

}  // namespace bedload::h5
