#pragma once
// Shell completion and manual page, generated from the command line.

#include <CLI/CLI.hpp>
#include <string>

namespace bedload {

/// A script for bash that completes commands, options, their values, keys behind --set, and files.
std::string bash_completion(const CLI::App& app);

/// The manual page bedload(1), in roff.
std::string man_page(const CLI::App& app);

}  // namespace bedload
