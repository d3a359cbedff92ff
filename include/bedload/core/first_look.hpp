#pragma once
// A build for a first look (BEDLOAD_FIRST_LOOK of CMake) is done sooner: it leaves out what few cases need,
// and refuses those.

#include <string>

#include "bedload/core/error.hpp"

#ifndef BL_FIRST_LOOK
#define BL_FIRST_LOOK 0
#endif

namespace bedload {

inline constexpr bool kFirstLook = BL_FIRST_LOOK;

/// Throws KeyError: the value of `key` is beyond what this build has, `only`.
[[noreturn]] inline void not_in_first_look(const std::string& key, const std::string& only) {
  throw KeyError(key, key + ": this program was built for a first look and has " + only +
                          "; build the whole one (tools/demo --full, or -DBEDLOAD_FIRST_LOOK=OFF)");
}

}  // namespace bedload
