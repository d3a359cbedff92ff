#pragma once
// Frames of places at equal distances: VTKHDF 2.0, temporal ImageData. What FrameFile does with them, below
// the group VTKHDF of its file. Each array has the extents step, z, y, x and those of a vector; a step may
// refer to the values of one before.

#include "bedload/host_data.hpp"
#include "bedload/output/h5.hpp"

namespace bedload::image {

/// Whether the file is such a one.
bool is_image(hid_t root);
/// Writes the layout of a new file.
void create_layout(hid_t root, const HostStore& store, int deflate);
/// Adds a frame at `time` s. Arrays that did not change since the last are not stored again.
void append(hid_t root, const HostStore& store, double time);
/// Throws h5::Error unless frames of this store can follow those in the file.
void expect(hid_t root, const HostStore& store);
/// One frame; its first array is the position.
HostStore read(hid_t root, const std::string& name, std::size_t frame);
/// Keeps the first frames.
void truncate(hid_t root, std::size_t frames);

HostGrid grid_of(hid_t root);

}  // namespace bedload::image
