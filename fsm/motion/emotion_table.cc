#include "fsm/motion/emotion_table.h"

#include <fmt/format.h>

#include "fsm/base/table_reader.h"

namespace fsm {
namespace {

void ReadTiming(const TableRow& row, EmotionTable& emotions) {
  if (row.size() != 6) row.Fail(row.key() + " NAME ONSET EYE BROW MOUTH expected");
  Emotion& emotion = emotions[row.Name(1, "an emotion's name")];
  Emotion::Timing& timing = row.key() == "posed" ? emotion.posed : emotion.elicited;
  timing.onset_ms = row.Number(2, "an onset in ms", 0, 10000);
  for (std::size_t i = 0; i < kRegions; ++i) {
    timing.lag_ms[i] = row.Number(3 + i, "a lag in ms", 0, 1000);
  }
}

void ReadPattern(const TableRow& row, const UnitNames& names, EmotionTable& emotions) {
  const double pattern = row.Number(1, "a pattern number", 1, 100);
  auto& patterns = emotions[row.Name(0, "an emotion's name")].patterns;
  if (pattern != static_cast<double>(patterns.size() + 1)) {
    row.Fail(fmt::format("pattern {:g} found, {} expected next", pattern, patterns.size() + 1));
  }
  patterns.push_back(ReadUnits(row, 2, names));
}

}  // namespace

vm::Result<EmotionTable> ReadEmotions(const std::string& name, std::string_view text,
                                      const UnitNames& names) {
  return ReadTable(name, text, [&](const Table& table) {
    EmotionTable emotions;
    for (const TableRow& row : table.rows()) {
      if (row.key() == "posed" || row.key() == "elicited") {
        ReadTiming(row, emotions);
      } else {
        ReadPattern(row, names, emotions);
      }
    }
    for (const auto& [word, emotion] : emotions) {
      if (emotion.patterns.empty()) table.Fail("'" + word + "' has no pattern 1");
    }
    return emotions;
  });
}

}  // namespace fsm
