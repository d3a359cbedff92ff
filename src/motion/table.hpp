#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bedload/case/config/motion.hpp"

namespace bedload {

/// Reads a motion table: CSV whose header names the columns t [s], x, y, z [m] and rx, ry, rz [deg] in any
/// order, units in brackets optional; all but t may be left out and are then zero. Blank lines and lines
/// that begin with # do not count. Throws FileError, or CaseError with file, line and column.
std::vector<MotionRow> read_motion_table(const std::filesystem::path& path);

/// Throws CaseError unless there are two rows or more, finite and with t ascending; `place` names a row.
void check_rows(const std::vector<MotionRow>& rows, const std::string& table,
                const std::function<std::string(std::size_t)>& place);

}  // namespace bedload
