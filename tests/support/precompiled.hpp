// What most tests include: read once for each program of tests (tools/cmake/tests.cmake).

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <regex>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/read.hpp"
#include "bedload/simulation.hpp"
#ifdef BL_REAL
#include "tests/support/grain_bench.hpp"
#include "tests/support/run.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"
#endif
