#include "fsm/motion/inputs/motion_tables.h"

#include <optional>

#include "embedded/action_unit_list.h"
#include "embedded/action_unit_names.h"
#include "embedded/arkit.h"
#include "embedded/dominance.h"
#include "embedded/emotion_space.h"
#include "embedded/emotions.h"
#include "embedded/gestures.h"
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
#include "fsm/base/table_reader.h"
#include "fsm/motion/inputs/motion_reader.h"

namespace fsm {
namespace {

/// Reads tables one after the other and stores the first error.
class Loader {
 public:
  explicit Loader(const TableFolder& folder) : folder_(folder) {}

  /// `read(name, text, others...)` returns vm::Result<T>.
  template <typename T, typename Read, typename... Others>
  void Get(T& out, const std::string& file, std::string_view built_in, const Read& read,
           Others&&... others) {
    if (error_) return;
    const auto own = folder_.Find(file);
    if (!own) {
      error_ = own.error();
      return;
    }
    auto table =
        *own ? read((*own)->path, (*own)->text, others...) : read(file, built_in, others...);
    if (table) {
      out = std::move(*table);
    } else {
      error_ = table.error();
    }
  }
  const std::optional<vm::Error>& error() const { return error_; }

 private:
  const TableFolder& folder_;
  std::optional<vm::Error> error_;
};

void LoadMouth(Loader& loader, MotionTables& out) {
  Visemes& visemes14 = out.set14.visemes;
  Visemes& visemes28 = out.set28.visemes;
  loader.Get(visemes14, "mouth_shapes.txt", embedded::mouth_shapes(), ReadVisemes,
             VisemeSetId::k14);
  loader.Get(visemes28, "mouth_shapes_28.txt", embedded::mouth_shapes_28(), ReadVisemes,
             VisemeSetId::k28);
  loader.Get(out.reach, "dominance.txt", embedded::dominance(), ReadDominance, visemes14,
             visemes28);
  const auto phonemes = [&loader](PhonemeTable& table, const char* file, std::string_view built_in,
                                  const Visemes& visemes) {
    loader.Get(table, file, built_in, ReadPhonemeTable, visemes);
  };
  phonemes(out.set14.japanese, "phonemes_ja.txt", embedded::phonemes_ja(), visemes14);
  phonemes(out.set14.english, "phonemes_en.txt", embedded::phonemes_en(), visemes14);
  phonemes(out.set28.japanese, "phonemes28_ja.txt", embedded::phonemes28_ja(), visemes28);
  phonemes(out.set28.english, "phonemes28_en.txt", embedded::phonemes28_en(), visemes28);
  for (const VisemeSetId which : kVisemeSets) {
    VisemeSet& set = out.set(which);
    const Viseme* const rest = FindViseme(set.visemes, "rest");
    if (rest != nullptr) set.rest = static_cast<std::size_t>(rest - set.visemes.data());
  }
  loader.Get(out.engines, "phoneme_names.txt", embedded::phoneme_names(), ReadPhonemeNames,
             out.set28);
}

vm::Result<GestureNumbers> ReadGestures(const std::string& name, std::string_view text) {
  static const NumberTable built_in("tables/gestures.txt", embedded::gestures());
  return ReadTable(
      name, text, [&](const Table&) { return GestureNumbers(NumberTable(name, text, &built_in)); });
}

}  // namespace

vm::Result<MotionTables> MotionTables::Load(const TableFolder& folder) {
  MotionTables out;
  Loader loader(folder);
  LoadMouth(loader, out);
  loader.Get(out.unit_names, "action_unit_names.txt", embedded::action_unit_names(), ReadUnitNames);
  const UnitNames& names = out.unit_names;
  loader.Get(out.expressions, "emotions.txt", embedded::emotions(), ReadExpressions, names);
  loader.Get(out.emotion_space, "emotion_space.txt", embedded::emotion_space(), ReadEmotionSpace,
             names);
  loader.Get(out.motions, "motions.txt", embedded::motions(), ReadMotions, names);
  loader.Get(out.units, "action_unit_list.txt", embedded::action_unit_list(), ReadUnitList, names);
  loader.Get(out.blend_shapes, "arkit.txt", embedded::arkit(), ReadBlendShapes, names);
  loader.Get(out.mixer, "mixing.txt", embedded::mixing(), Mixer::Read);
  loader.Get(out.text_cues, "text_cues.txt", embedded::text_cues(), ReadTextCues, names);
  loader.Get(out.gestures, "gestures.txt", embedded::gestures(), ReadGestures);
  if (loader.error()) return std::unexpected(*loader.error());
  return out;
}

}  // namespace fsm
