#include "fsm/motion/emotion_table.h"

#include <fmt/format.h>

#include "fsm/motion/table_text.h"

namespace fsm {

vm::Result<EmotionTable> ReadEmotions(const std::string& name, std::string_view text,
                                      const UnitNames& names) {
  const TableText table(name, text);
  EmotionTable emotions;
  for (const TableLine& line : table.lines()) {
    if (line.words[0] == "posed" || line.words[0] == "elicited") {
      if (line.words.size() != 6) {
        return table.Wrong(line.number, line.words[0] + " NAME ONSET EYE BROW MOUTH expected");
      }
      if (auto named = table.Name(line, 1, "an emotion's name"); !named) {
        return std::unexpected(named.error());
      }
      Emotion& whole = emotions[line.words[1]];
      Emotion::Timing& emotion = line.words[0] == "posed" ? whole.posed : whole.elicited;
      const auto onset = table.Number(line, 2, "an onset in ms", 0, 10000);
      if (!onset) return std::unexpected(onset.error());
      emotion.onset_ms = *onset;
      for (std::size_t i = 0; i < kRegions; ++i) {
        const auto lag = table.Number(line, 3 + i, "a lag in ms", 0, 1000);
        if (!lag) return std::unexpected(lag.error());
        emotion.lag_ms[i] = *lag;
      }
      continue;
    }
    const auto pattern = table.Number(line, 1, "a pattern number", 1, 100);
    if (!pattern) return std::unexpected(pattern.error());
    if (auto named = table.Name(line, 0, "an emotion's name"); !named) {
      return std::unexpected(named.error());
    }
    Emotion& emotion = emotions[line.words[0]];
    if (*pattern != static_cast<double>(emotion.patterns.size() + 1)) {
      return table.Wrong(line.number, fmt::format("pattern {:g} found, {} expected next", *pattern,
                                                  emotion.patterns.size() + 1));
    }
    auto units = ReadUnits(table, line, 2, names);
    if (!units) return std::unexpected(units.error());
    emotion.patterns.push_back(*units);
  }
  for (const auto& [word, emotion] : emotions) {
    if (emotion.patterns.empty()) return table.Wrong(0, "'" + word + "' has no pattern 1");
  }
  return emotions;
}

}  // namespace fsm
