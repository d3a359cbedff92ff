// Cases of other programs to cases, frames to other formats.

#include <fmt/format.h>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "commands.hpp"
#include "src/convert/case_text.hpp"
#include "src/convert/convert.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

void refuse_to_overwrite(const fs::path& file, const Options& o) {
  if (fs::is_directory(file)) throw FileError(file.string() + ": cannot write: it is a folder");
  if (fs::exists(file) && !o.overwrite)
    throw FileError(file.string() + ": exists; add --overwrite, or name another file with --out");
}

int convert_results(const Options& o) {
  const bool lammps = o.to == "lammps";
  fs::path out = o.out;
  if (out.empty()) {
    out = fs::is_directory(o.file) ? o.file / "frames" : fs::path(o.file).replace_extension();
    out += lammps ? ".lammpstrj" : ".extxyz";
  }
  refuse_to_overwrite(out, o);
  const std::size_t frames = convert_frames(o.file, lammps ? FrameFormat::lammps : FrameFormat::extxyz, out);
  fmt::print("wrote {} with {} frames\n", out.string(), frames);
  return 0;
}

/// dam.toml for Dam_Def.xml and for in.dam.
fs::path case_of(const fs::path& file, bool xml) {
  std::string name = file.filename().string();
  if (xml) {
    name = file.stem().string();
    if (name.ends_with("_Def")) name.resize(name.size() - 4);
  } else if (name.starts_with("in.")) {
    name = name.substr(3);
  } else {
    name = file.stem().string();
  }
  return name + ".toml";
}

int convert_case(const Options& o, bool xml) {
  if (!o.to.empty())
    throw CaseError(fmt::format(
        "command line: --to {}: only frames, a results folder or a .vtkhdf file, have formats", o.to));
  const fs::path out = o.out.empty() ? case_of(o.file, xml) : o.out;
  refuse_to_overwrite(out, o);
  const fs::path folder = fs::absolute(out).parent_path();
  const Conversion made = xml ? from_dualsphysics(o.file, folder) : from_liggghts(o.file, folder);

  std::string text = comment_text(fmt::format("Made by `bedload convert` from {}, a case of {}.",
                                              o.file.filename().string(), xml ? "DualSPHysics" : "LIGGGHTS"));
  if (!made.left.empty()) {
    text += "#\n# What has no counterpart, or another one than there:\n";
    for (const std::string& line : made.left) text += comment_text(line, "- ");
  }
  text += '\n' + made.toml;
  write_file(out, text);
  for (const std::string& line : made.left) fmt::print(stderr, "{}\n", line);
  fmt::print("wrote {}; next: bedload check {} --preview look\n", out.string(), out.string());
  return 0;
}

}  // namespace

int convert(const Options& o) {
  if (fs::is_directory(o.file) || o.file.extension() == ".vtkhdf") return convert_results(o);
  if (!fs::is_regular_file(o.file))
    throw FileError(o.file.string() + ": cannot read: no such file or folder");
  if (o.file.extension() == ".toml") throw CaseError(o.file.string() + ": is a case of Bedload already");
  return convert_case(o, o.file.extension() == ".xml");
}

}  // namespace bedload
