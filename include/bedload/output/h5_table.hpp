#pragma once
// HDF5 datasets that grow by rows.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bedload/output/h5.hpp"

namespace bedload::h5 {

Handle open_dataset(hid_t parent, const std::string& name);

/// An empty table of `columns`, stored in chunks of rows.
Handle create_table(hid_t parent, const std::string& name, hid_t type, hsize_t columns, hsize_t chunk_rows,
                    int deflate = 0);

void resize(hid_t table, hsize_t rows);

/// Rows [first, first + rows) of a table as file and memory space.
std::pair<Handle, Handle> rows_of(hid_t table, hsize_t first, hsize_t rows);

void append_rows(hid_t table, hid_t type, const void* data, hsize_t rows);
void read_rows(hid_t table, hid_t type, hsize_t first, hsize_t rows, void* data);

/// Whether `rows` rows from `first` equal `data`; gives up at the first block that differs.
bool rows_equal(hid_t table, Scalar type, hsize_t first, hsize_t rows, const std::byte* data,
                std::size_t row_bytes);

/// 64-bit integers, as VTKHDF keeps its counts and offsets.
void append_integers(hid_t parent, const std::string& name, const std::vector<std::int64_t>& values,
                     hsize_t rows);
std::vector<std::int64_t> read_integers(hid_t parent, const std::string& name, hsize_t rows);

}  // namespace bedload::h5
