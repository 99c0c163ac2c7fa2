#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

/// Data of others that some tests look at and that are not in the repository; tests/README.md says
/// where each is to be had.
namespace support {

/// A folder or file of such data: what the variable names, else its place beside the source tree.
class TestData {
 public:
  TestData(const char* what, const char* variable, const char* place)
      : what_(what), variable_(variable) {
    const char* named = std::getenv(variable);
    path_ = named ? named : GALATEA_SOURCE_DIR "/../shared/data/" + std::string(place);
    place_ = named ? path_ : "../shared/data/" + std::string(place);
  }
  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  bool Has() const { return std::filesystem::exists(path_); }
  bool Has(const std::string& name) const { return std::filesystem::exists(*this / name); }

  /// What a test that is skipped without them says.
  std::string Missing() const {
    return "needs " + what_ + " in " + place_ + " (or where " + variable_ +
           " says; tests/README.md: where to get them)";
  }

 private:
  std::string what_, variable_, path_, place_;
};

inline TestData Photos() { return {"photos of faces", "GALATEA_PHOTOS", "photos"}; }
inline TestData Heads() { return {"heads of other makers", "GALATEA_HEADS", "heads"}; }
inline TestData Original() { return {"the original's face", "GALATEA_ORIGINAL", "galatea_fsm"}; }

}  // namespace support
