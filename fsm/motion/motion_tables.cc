#include "fsm/motion/motion_tables.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "embedded/action_unit_list.h"
#include "embedded/arkit.h"
#include "embedded/emotions.h"
#include "embedded/motions.h"
#include "embedded/mouth_shapes.h"
#include "embedded/phonemes_en.h"
#include "embedded/phonemes_ja.h"

namespace fsm {
namespace {

/// Reads one table after the other and remembers the first thing that went wrong.
class Loader {
 public:
  explicit Loader(std::string folder) : folder_(std::move(folder)) {
    std::error_code code;
    if (!folder_.empty() && !std::filesystem::is_directory(folder_, code)) {
      error_ = vm::Error{vm::Errc::kUnavailable, "'" + folder_ + "' is not a folder of tables"};
    }
  }

  /// `read(name, text)` gives vm::Result<T>.
  template <typename T, typename Read>
  void Get(T& out, const std::string& file, std::string_view built_in, const Read& read) {
    if (error_) return;
    const std::string path = folder_.empty() ? file : folder_ + "/" + file;
    std::string text(built_in);
    if (!folder_.empty() && std::filesystem::exists(path)) {
      std::ifstream in(path, std::ios::binary);
      std::ostringstream bytes;
      bytes << in.rdbuf();
      if (!in) {
        error_ = vm::Error{vm::Errc::kUnavailable, "cannot read " + path};
        return;
      }
      text = bytes.str();
    }
    auto table = read(path, text);
    if (table) {
      out = std::move(*table);
    } else {
      error_ = table.error();
    }
  }
  const std::optional<vm::Error>& error() const { return error_; }

 private:
  std::string folder_;
  std::optional<vm::Error> error_;
};

}  // namespace

vm::Result<MotionTables> MotionTables::Load(const std::string& folder) {
  MotionTables out;
  Loader loader(folder);
  const auto phonemes = [&out](const std::string& name, std::string_view text) {
    return ReadPhonemeTable(name, text, out.shapes);
  };
  loader.Get(out.shapes, "mouth_shapes.txt", embedded::mouth_shapes(), ReadMouthShapes);
  loader.Get(out.phonemes_ja, "phonemes_ja.txt", embedded::phonemes_ja(), phonemes);
  loader.Get(out.phonemes_en, "phonemes_en.txt", embedded::phonemes_en(), phonemes);
  loader.Get(out.emotions, "emotions.txt", embedded::emotions(), ReadEmotions);
  loader.Get(out.motions, "motions.txt", embedded::motions(), ReadMotions);
  loader.Get(out.units, "action_unit_list.txt", embedded::action_unit_list(), ReadUnitList);
  loader.Get(out.blend_shapes, "arkit.txt", embedded::arkit(), ReadBlendShapes);
  if (loader.error()) return std::unexpected(*loader.error());
  return out;
}

}  // namespace fsm
