// The window is a part of the Python package: the program starts it.

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "bedload/core/error.hpp"
#include "commands.hpp"

namespace bedload {
namespace {

/// Starts the window, or ends with a sentence if the package is not there.
constexpr const char* kStart = R"(import sys
try:
    from bedload.gui import main
except ImportError:
    print(f'bedload gui: {sys.executable} has no package bedload with the window; install it with: '
          'pip install "bedload[gui]", or name another Python in BEDLOAD_PYTHON', file=sys.stderr)
    sys.exit(2)
sys.exit(main(sys.argv[1:])))";

}  // namespace

int open_window(const Options& options) {
  const char* named = std::getenv("BEDLOAD_PYTHON");
  const std::string python = named && *named ? named : "python3";
  std::vector<std::string> words = {python, "-c", kStart};
  if (!options.file.empty()) words.push_back(options.file);
  if (options.window.port >= 0) words.push_back(fmt::format("--port={}", options.window.port));
  if (options.window.no_browser) words.push_back("--no-browser");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::fflush(nullptr);
  execvp(arguments[0], arguments.data());  // returns only if it fails
  throw FileError(fmt::format("bedload gui needs Python: {}: {}", python, std::strerror(errno)));
}

}  // namespace bedload
