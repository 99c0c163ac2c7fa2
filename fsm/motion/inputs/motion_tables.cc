#include "fsm/motion/inputs/motion_tables.h"

#include <algorithm>
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

/// A table's file and its built-in text.
struct TableSource {
  std::string_view file;
  std::string_view (*built_in)();
};
constexpr TableSource kSources[] = {{"action_unit_list.txt", embedded::action_unit_list},
                                    {kUnitNamesTable, embedded::action_unit_names},
                                    {"arkit.txt", embedded::arkit},
                                    {"dominance.txt", embedded::dominance},
                                    {"emotion_space.txt", embedded::emotion_space},
                                    {"emotions.txt", embedded::emotions},
                                    {"gestures.txt", embedded::gestures},
                                    {"mixing.txt", embedded::mixing},
                                    {"motions.txt", embedded::motions},
                                    {"mouth_shapes.txt", embedded::mouth_shapes},
                                    {"mouth_shapes_28.txt", embedded::mouth_shapes_28},
                                    {"phoneme_names.txt", embedded::phoneme_names},
                                    {"phonemes28_en.txt", embedded::phonemes28_en},
                                    {"phonemes28_ja.txt", embedded::phonemes28_ja},
                                    {"phonemes_en.txt", embedded::phonemes_en},
                                    {"phonemes_ja.txt", embedded::phonemes_ja},
                                    {"text_cues.txt", embedded::text_cues}};

/// Returns the table of a file; one that is not listed above does not compile.
consteval TableSource Source(std::string_view file) {
  return *std::ranges::find(kSources, file, &TableSource::file);
}

/// Reads tables one after the other and stores the first error.
class Loader {
 public:
  explicit Loader(const TableFolder& folder) : folder_(folder) {}

  /// `read(name, text, others...)` returns vm::Result<T>.
  template <typename T, typename Read, typename... Others>
  void Get(T& out, const TableSource& source, const Read& read, Others&&... others) {
    if (error_) return;
    const auto own = folder_.Find(source.file);
    if (!own) {
      error_ = own.error();
      return;
    }
    auto table = *own ? read((*own)->path, (*own)->text, others...)
                      : read(std::string(source.file), source.built_in(), others...);
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

/// The tables of a set of visemes.
struct VisemeSources {
  VisemeSetId set;
  TableSource shapes, japanese, english;
};
constexpr VisemeSources kVisemeSources[] = {
    {VisemeSetId::k14, Source("mouth_shapes.txt"), Source("phonemes_ja.txt"),
     Source("phonemes_en.txt")},
    {VisemeSetId::k28, Source("mouth_shapes_28.txt"), Source("phonemes28_ja.txt"),
     Source("phonemes28_en.txt")}};

void LoadMouth(Loader& loader, MotionTables& out) {
  for (const auto& [id, shapes, japanese, english] : kVisemeSources) {
    VisemeSet& set = out.sets[id];
    loader.Get(set.visemes, shapes, ReadVisemes, id);
    loader.Get(set.japanese, japanese, ReadPhonemeTable, set.visemes);
    loader.Get(set.english, english, ReadPhonemeTable, set.visemes);
    const Viseme* const rest = FindViseme(set.visemes, "rest");
    if (rest != nullptr) set.rest = static_cast<std::size_t>(rest - set.visemes.data());
  }
  loader.Get(out.reach, Source("dominance.txt"), ReadDominance, out.sets);
  loader.Get(out.engines, Source("phoneme_names.txt"), ReadPhonemeNames, out.set(VisemeSetId::k28));
}

vm::Result<MovementNumbers> ReadGestures(const std::string& name, std::string_view text) {
  static const NumberTable built_in("tables/gestures.txt", embedded::gestures());
  return ReadTable(name, text, [&](const Table&) {
    return MovementNumbers(NumberTable(name, text, &built_in));
  });
}

}  // namespace

std::vector<std::string_view> MotionTables::Files() {
  std::vector<std::string_view> files;
  for (const TableSource& source : kSources) files.push_back(source.file);
  return files;
}

vm::Result<MotionTables> MotionTables::Load(const TableFolder& folder) {
  MotionTables out;
  Loader loader(folder);
  LoadMouth(loader, out);
  loader.Get(out.unit_names, Source(kUnitNamesTable), ReadUnitNames);
  const UnitNames& names = out.unit_names;
  loader.Get(out.expressions, Source("emotions.txt"), ReadExpressions, names);
  loader.Get(out.emotion_space, Source("emotion_space.txt"), ReadEmotionSpace, names);
  loader.Get(out.motions, Source("motions.txt"), ReadMotions, names);
  loader.Get(out.unit_list, Source("action_unit_list.txt"), ReadUnitList, names);
  loader.Get(out.blend_shapes, Source("arkit.txt"), ReadBlendShapes, names);
  loader.Get(out.mixer, Source("mixing.txt"), Mixer::Read);
  loader.Get(out.text_cues, Source("text_cues.txt"), ReadTextCues, names);
  loader.Get(out.gestures, Source("gestures.txt"), ReadGestures);
  if (loader.error()) return std::unexpected(*loader.error());
  return out;
}

}  // namespace fsm
