#pragma once
// What the fuzz targets share. Each gives the bytes that libFuzzer makes up to readers of files. A reader may
// take them or refuse them with one sentence; anything else is a finding.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include "bedload/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace bedload::fuzz {

/// A file in a folder of this process, holding `bytes`.
inline std::filesystem::path file_of(const std::string& name, std::string_view bytes) {
  static const test::TemporaryFolder folder;
  const auto path = folder / name;
  std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  return path;
}

inline void check_sentence(std::string_view text) {
  if (!text.empty() && text.find('\n') == text.npos) return;
  std::fprintf(stderr, "not one sentence: \"%.*s\"\n", int(text.size()), text.data());
  std::abort();
}

/// Runs `read`, which may refuse what it is given.
template <class Read>
void attempt(Read read) {
  try {
    read();
  } catch (const CaseError& error) {
    check_sentence(error.what());
  } catch (const FileError& error) {
    check_sentence(error.what());
  }
}

}  // namespace bedload::fuzz
