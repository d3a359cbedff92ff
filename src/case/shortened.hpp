#pragma once
// Values in messages.

#include <string>

namespace bedload {

/// A text that is longer than `most` bytes without its middle, and how long it was.
std::string shortened(const std::string& text, std::size_t most = 200);

}  // namespace bedload
