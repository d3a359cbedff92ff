#pragma once
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace bedload::test {

/// A new empty folder, removed with all in it at the end of its life.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "bedload_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// A text as it would be if this folder's files were named without it.
  std::string left_out_of(std::string text) const {
    const std::string name = path_.string() + "/";
    for (std::size_t at; (at = text.find(name)) != text.npos;) text.erase(at, name.size());
    return text;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace bedload::test
