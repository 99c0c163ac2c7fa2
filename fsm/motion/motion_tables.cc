#include "fsm/motion/motion_tables.h"

#include <filesystem>
#include <optional>

#include "embedded/action_unit_list.h"
#include "embedded/action_unit_names.h"
#include "embedded/arkit.h"
#include "embedded/dominance.h"
#include "embedded/emotions.h"
#include "embedded/mixing.h"
#include "embedded/motions.h"
#include "embedded/mouth_shapes.h"
#include "embedded/mouth_shapes_28.h"
#include "embedded/phoneme_names.h"
#include "embedded/phonemes28_en.h"
#include "embedded/phonemes28_ja.h"
#include "embedded/phonemes_en.h"
#include "embedded/phonemes_ja.h"
#include "embedded/text_cues.h"
#include "fsm/motion/table_text.h"

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
    std::error_code code;
    if (!folder_.empty() && std::filesystem::exists(path, code)) {
      auto own = ReadTableFile(path);
      if (!own) {
        error_ = own.error();
        return;
      }
      if (auto encoded = CheckTableEncoding(path, *own); !encoded) {
        error_ = encoded.error();
        return;
      }
      text = std::move(*own);
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

void LoadMouth(Loader& loader, MotionTables& out) {
  const auto shapes28 = [](const std::string& name, std::string_view text) {
    return ReadVisemes(name, text, kBilingualShapes);
  };
  const auto phonemes_of = [](const MouthSet& set) {
    return [&set](const std::string& name, std::string_view text) {
      return ReadPhonemeTable(name, text, set.shapes);
    };
  };
  const auto shapes14 = [](const std::string& name, std::string_view text) {
    return ReadVisemes(name, text);
  };
  loader.Get(out.set14.shapes, "mouth_shapes.txt", embedded::mouth_shapes(), shapes14);
  loader.Get(out.set28.shapes, "mouth_shapes_28.txt", embedded::mouth_shapes_28(), shapes28);
  loader.Get(out.reach, "dominance.txt", embedded::dominance(),
             [&out](const std::string& name, std::string_view text) {
               return ReadDominance(name, text, out.set14.shapes, out.set28.shapes);
             });
  const auto of14 = phonemes_of(out.set14);
  const auto of28 = phonemes_of(out.set28);
  loader.Get(out.set14.japanese, "phonemes_ja.txt", embedded::phonemes_ja(), of14);
  loader.Get(out.set14.english, "phonemes_en.txt", embedded::phonemes_en(), of14);
  loader.Get(out.set28.japanese, "phonemes28_ja.txt", embedded::phonemes28_ja(), of28);
  loader.Get(out.set28.english, "phonemes28_en.txt", embedded::phonemes28_en(), of28);
  for (MouthSet* set : {&out.set14, &out.set28}) {
    for (std::size_t i = 0; i < set->shapes.size(); ++i) {
      if (set->shapes[i].name == "rest") set->rest = i;
    }
  }
  loader.Get(out.engines, "phoneme_names.txt", embedded::phoneme_names(),
             [&out](const std::string& name, std::string_view text) {
               return ReadPhonemeNames(name, text, out.set28);
             });
}

}  // namespace

vm::Result<MotionTables> MotionTables::Load(const std::string& folder) {
  MotionTables out;
  Loader loader(folder);
  LoadMouth(loader, out);
  loader.Get(out.unit_names, "action_unit_names.txt", embedded::action_unit_names(), ReadUnitNames);
  const auto with_names = [&out](const auto& read) {
    return [&out, &read](const std::string& name, std::string_view text) {
      return read(name, text, out.unit_names);
    };
  };
  loader.Get(out.emotions, "emotions.txt", embedded::emotions(), with_names(ReadEmotions));
  loader.Get(out.motions, "motions.txt", embedded::motions(), with_names(ReadMotions));
  loader.Get(out.units, "action_unit_list.txt", embedded::action_unit_list(),
             with_names(ReadUnitList));
  loader.Get(out.blend_shapes, "arkit.txt", embedded::arkit(), with_names(ReadBlendShapes));
  loader.Get(out.mixer, "mixing.txt", embedded::mixing(), Mixer::Read);
  loader.Get(out.text_cues, "text_cues.txt", embedded::text_cues(), with_names(ReadTextCues));
  if (loader.error()) return std::unexpected(*loader.error());
  return out;
}

}  // namespace fsm
