#include "bedload/output/h5_table.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <optional>

#include "bedload/parallel/host_loop.hpp"

namespace bedload::h5 {
namespace {

/// A part of an array, and where in the file it is.
struct Piece {
  std::size_t at;  ///< byte of the array
  std::size_t bytes;
  haddr_t in_file;
};

constexpr std::size_t kPiece = 256 << 10;  ///< bytes: less than a core's own cache

/// Where rows are, if an ordinary file has them as they are in memory.
struct PlainRows {
  int file = -1;  ///< descriptor
  std::vector<Piece> pieces;
};

std::optional<PlainRows> plain_rows(hid_t table, Scalar type, hsize_t first, hsize_t rows,
                                    std::size_t row_bytes) {
#if H5_VERSION_GE(1, 10, 5)
  const Handle creation(H5Dget_create_plist(table));
  const auto n = extent(table);
  hsize_t chunk[2] = {0, 1};
  if (n.empty() || n.size() > 2 || H5Pget_layout(creation) != H5D_CHUNKED || H5Pget_nfilters(creation) != 0 ||
      H5Pget_chunk(creation, 2, chunk) != int(n.size()) || (n.size() == 2 && chunk[1] != n[1]) ||
      check(H5Tequal(Handle(H5Dget_type(table)), memory_type(type))) == 0)
    return {};
  const Handle file(H5Iget_file_id(table)), access(H5Fget_access_plist(file));
  void* descriptor = nullptr;
  if (H5Pget_driver(access) != H5FD_SEC2) return {};
  check(H5Dflush(table));
  check(H5Fget_vfd_handle(file, access, &descriptor));
  PlainRows out{*static_cast<const int*>(descriptor), {}};
  for (hsize_t row = first; row < first + rows;) {
    const hsize_t start[2] = {row / chunk[0] * chunk[0], 0},
                  end = std::min(start[0] + chunk[0], first + rows);
    unsigned filters = 0;
    haddr_t address = HADDR_UNDEF;
    hsize_t stored = 0;
    check(H5Dget_chunk_info_by_coord(table, start, &filters, &address, &stored));
    if (address == HADDR_UNDEF || stored != chunk[0] * row_bytes) return {};
    address += (row - start[0]) * row_bytes;
    const std::size_t at = (row - first) * row_bytes, bytes = (end - row) * row_bytes;
    for (std::size_t k = 0; k < bytes; k += kPiece)
      out.pieces.push_back({at + k, std::min(kPiece, bytes - k), address + k});
    row = end;
  }
  return out;
#else
  return {};
#endif
}

bool equal(const PlainRows& rows, const std::byte* data) {
  std::atomic<bool> all = true;
  const auto compare = [&](std::size_t k) {
    if (!all) return;
    thread_local std::vector<std::byte> block;
    const Piece& piece = rows.pieces[k];
    block.resize(piece.bytes);
    if (::pread(rows.file, block.data(), piece.bytes, off_t(piece.in_file)) != ssize_t(piece.bytes) ||
        std::memcmp(block.data(), data + piece.at, piece.bytes) != 0)
      all = false;
  };
  if (!rows.pieces.empty()) compare(0);  // most arrays that change do so there
  if (all) host_for_each(rows.pieces.size(), compare);
  return all;
}

}  // namespace

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
  if (rows * row_bytes > kPiece)
    if (const auto plain = plain_rows(table, type, first, rows, row_bytes)) return equal(*plain, data);
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
