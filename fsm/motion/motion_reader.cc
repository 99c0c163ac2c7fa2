#include <fmt/format.h>

#include "fsm/motion/motion_table.h"
#include "fsm/motion/table_text.h"

namespace fsm {
namespace {

constexpr std::size_t kMaxKeys = 100000;

vm::Result<HeadCurve::Key> ReadKey(const TableText& table, const TableLine& line, double after_ms) {
  if (line.words.size() != 4) return table.Wrong(line.number, "a key frame 'ms x y z' expected");
  HeadCurve::Key key;
  const auto ms = table.Number(line, 0, "a time in ms", 0, 86400000);
  if (!ms) return std::unexpected(ms.error());
  if (*ms <= after_ms) {
    return table.Wrong(line.number, fmt::format("{:g} ms is not after the key before it", *ms));
  }
  key.ms = *ms;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto angle = table.Number(line, 1 + axis, "an angle in degrees", -180, 180);
    if (!angle) return std::unexpected(angle.error());
    key.angles[axis] = static_cast<float>(*angle);
  }
  return key;
}

bool StartsWithNumber(const TableLine& line) { return ParseNumber(line.words[0]).has_value(); }

}  // namespace

vm::Result<HeadCurve> ReadMotionFile(const std::string& name, std::string_view text) {
  const TableText table(name, text);
  std::vector<HeadCurve::Key> keys;
  bool count_seen = false;
  for (const TableLine& line : table.lines()) {
    // Comments begin with // and are in any encoding; a line that is no number is one too.
    if (!StartsWithNumber(line)) continue;
    if (!count_seen && line.words.size() == 1) {
      count_seen = true;
      continue;
    }
    const auto key = ReadKey(table, line, keys.empty() ? 0 : keys.back().ms);
    if (!key) return std::unexpected(key.error());
    if (keys.size() == kMaxKeys) return table.Wrong(line.number, "too many key frames");
    keys.push_back(*key);
  }
  if (keys.empty()) return table.Wrong(0, "no key frame 'ms x y z' found");
  return HeadCurve(std::move(keys));
}

namespace {

/// Reads the lines of a table of motions, one after the other.
class MotionReader {
 public:
  MotionReader(const std::string& name, std::string_view text, const UnitNames& units)
      : table_(name, text), units_(units) {}
  vm::Result<MotionTable> Read();

 private:
  using Numbers = std::vector<double>;
  vm::Result<void> ReadLine(const TableLine& line);
  vm::Result<void> ReadCurve(const TableLine& line);
  vm::Result<void> ReadProfile(const TableLine& line);
  vm::Result<void> ReadFace(const TableLine& line);
  vm::Result<void> ReadMood(const TableLine& line);
  /// The numbers after the pattern's, which must be the next; from 0 on, the last at least `least`.
  vm::Result<Numbers> ReadNumbers(const TableLine& line, std::size_t have, std::size_t count,
                                  const std::string& expected, double least = 0);
  /// A pattern of which each number is one field.
  template <typename Pattern, typename... Fields>
  vm::Result<void> ReadPattern(const TableLine& line, std::vector<Pattern>& patterns,
                               const std::string& expected, double least, Fields... fields);
  vm::Result<void> ReadBlinks(const TableLine& line);
  vm::Result<void> ReadMove(const TableLine& line);
  vm::Result<void> CheckPattern(const TableLine& line, std::size_t have);

  TableText table_;
  const UnitNames& units_;
  std::size_t at_ = 0;  // the line in hand
  MotionTable out_;
};

vm::Result<MotionTable> MotionReader::Read() {
  for (; at_ < table_.lines().size(); ++at_) {
    if (auto read = ReadLine(table_.lines()[at_]); !read) return std::unexpected(read.error());
  }
  return std::move(out_);
}

vm::Result<void> MotionReader::CheckPattern(const TableLine& line, std::size_t have) {
  const auto pattern = table_.Number(line, 1, "a pattern number", 1, 10000);
  if (!pattern) return std::unexpected(pattern.error());
  if (*pattern != static_cast<double>(have + 1)) {
    return table_.Wrong(line.number,
                        fmt::format("pattern {:g} found, {} expected next", *pattern, have + 1));
  }
  return {};
}

vm::Result<MotionReader::Numbers> MotionReader::ReadNumbers(const TableLine& line, std::size_t have,
                                                            std::size_t count,
                                                            const std::string& expected,
                                                            double least) {
  if (auto fits = CheckPattern(line, have); !fits) return std::unexpected(fits.error());
  if (line.words.size() != count + 2) return table_.Wrong(line.number, expected + " expected");
  Numbers numbers;
  for (std::size_t i = 0; i < count; ++i) {
    const bool last = i + 1 == count;
    const auto number = table_.Number(line, 2 + i, expected, last ? least : 0, 3600000);
    if (!number) return std::unexpected(number.error());
    numbers.push_back(*number);
  }
  return numbers;
}

vm::Result<void> MotionReader::ReadCurve(const TableLine& line) {
  auto& curves = out_.head[line.words[0]];
  if (auto fits = CheckPattern(line, curves.size()); !fits) return fits;
  std::vector<HeadCurve::Key> keys;
  while (at_ + 1 < table_.lines().size() && StartsWithNumber(table_.lines()[at_ + 1])) {
    const auto key = ReadKey(table_, table_.lines()[++at_], keys.empty() ? 0 : keys.back().ms);
    if (!key) return std::unexpected(key.error());
    if (keys.size() == kMaxKeys) return table_.Wrong(line.number, "too many key frames");
    keys.push_back(*key);
  }
  if (keys.empty()) return table_.Wrong(line.number, "key frames 'ms x y z' expected below");
  curves.emplace_back(std::move(keys));
  return {};
}

vm::Result<void> MotionReader::ReadFace(const TableLine& line) {
  if (auto fits = CheckPattern(line, out_.auto_faces.size()); !fits) return fits;
  auto units = ReadUnits(table_, line, 2, units_);
  if (!units) return std::unexpected(units.error());
  out_.auto_faces.push_back(*units);
  return {};
}

vm::Result<void> MotionReader::ReadMood(const TableLine& line) {
  if (line.words.size() < 3 || line.words[1] == "NEUTRAL") {
    return table_.Wrong(line.number, "MOOD NAME AU:WEIGHT ... expected, the name not NEUTRAL");
  }
  auto units = ReadUnits(table_, line, 2, units_);
  if (!units) return std::unexpected(units.error());
  out_.moods[line.words[1]] = *units;
  return {};
}

vm::Result<void> MotionReader::ReadProfile(const TableLine& line) {
  if (line.words.size() < 2 || line.words.size() % 2 != 0) {
    return table_.Wrong(line.number, "LIFE NAME KIND PATTERN ... expected");
  }
  IdleProfile profile{};
  for (std::size_t i = 2; i < line.words.size(); i += 2) {
    const auto kind = IdleKindNamed(line.words[i]);
    if (!kind) {
      return table_.Wrong(line.number,
                          fmt::format("'{}' found, a kind of Autonomous expected", line.words[i]));
    }
    const auto pattern = table_.Number(line, i + 1, "a pattern given above", 0,
                                       static_cast<double>(out_.Patterns(*kind)));
    if (!pattern) return std::unexpected(pattern.error());
    profile[static_cast<std::size_t>(*kind)] = static_cast<std::size_t>(*pattern);
  }
  out_.profiles[line.words[1]] = profile;
  return {};
}

template <typename Pattern, typename... Fields>
vm::Result<void> MotionReader::ReadPattern(const TableLine& line, std::vector<Pattern>& patterns,
                                           const std::string& expected, double least,
                                           Fields... fields) {
  const auto numbers = ReadNumbers(line, patterns.size(), sizeof...(fields), expected, least);
  if (!numbers) return std::unexpected(numbers.error());
  Pattern pattern;
  auto next = numbers->begin();
  ((pattern.*fields = *next++), ...);
  patterns.push_back(pattern);
  return {};
}

vm::Result<void> MotionReader::ReadBlinks(const TableLine& line) {
  const auto v = ReadNumbers(line, out_.auto_blinks.size(), 2, "AUTOBLINK PATTERN INTERVAL BLINK");
  if (!v) return std::unexpected(v.error());
  if ((*v)[0] < 500 || (*v)[1] < 1 || (*v)[1] > static_cast<double>(out_.blinks.size())) {
    return table_.Wrong(line.number, "an interval of at least 500 ms and a blink above expected");
  }
  out_.auto_blinks.push_back({(*v)[0], static_cast<std::size_t>((*v)[1]) - 1, true});
  return {};
}

vm::Result<void> MotionReader::ReadMove(const TableLine& line) {
  const auto v = ReadNumbers(line, out_.auto_moves.size(), 4,
                             "AUTOMOVE PATTERN X Y Z PERIOD, at least 100 ms,", 100);
  if (!v) return std::unexpected(v.error());
  AutoMove move{.period_ms = (*v)[3]};
  for (std::size_t axis = 0; axis < 3; ++axis)
    move.amplitude[axis] = static_cast<float>((*v)[axis]);
  out_.auto_moves.push_back(move);
  return {};
}

vm::Result<void> MotionReader::ReadLine(const TableLine& line) {
  const std::string& kind = line.words[0];
  if (kind == "NOD" || kind == "REFUSE" || kind == "LISTEN" || kind == "USERDEF") {
    return ReadCurve(line);
  }
  if (kind == "BLINK") {
    return ReadPattern(line, out_.blinks, "BLINK PATTERN CLOSING SHUT OPENING, ms,", 1,
                       &BlinkPattern::closing_ms, &BlinkPattern::shut_ms,
                       &BlinkPattern::opening_ms);
  }
  if (kind == "AUTOBLINK") return ReadBlinks(line);
  if (kind == "AUTOMOVE") return ReadMove(line);
  if (kind == "AUTOGAZE") {
    return ReadPattern(line, out_.auto_gazes, "AUTOGAZE PATTERN ANGLE INTERVAL, at least 200 ms,",
                       200, &AutoGaze::amplitude, &AutoGaze::interval_ms);
  }
  if (kind == "AUTOBREATH") {
    return ReadPattern(line, out_.auto_breaths, "AUTOBREATH PATTERN PITCH PERIOD, at least 500 ms,",
                       500, &AutoBreath::pitch, &AutoBreath::period_ms);
  }
  if (kind == "AUTONODS") {
    return ReadPattern(line, out_.auto_nods, "AUTONODS PATTERN ANGLE INTERVAL, at least 2000 ms,",
                       2000, &AutoNods::angle, &AutoNods::interval_ms);
  }
  if (kind == "AUTOSPEECH") {
    return ReadPattern(line, out_.auto_speeches, "AUTOSPEECH PATTERN NOD TURN TILT BROW", 0,
                       &AutoSpeech::nod, &AutoSpeech::turn, &AutoSpeech::tilt, &AutoSpeech::brow);
  }
  if (kind == "AUTOAVERT") {
    return ReadPattern(line, out_.auto_averts, "AUTOAVERT PATTERN ANGLE SHORTEST", 0,
                       &AutoAvert::angle, &AutoAvert::shortest_ms);
  }
  if (kind == "AUTOFACE") return ReadFace(line);
  if (kind == "MOOD") return ReadMood(line);
  if (kind == "LIFE") return ReadProfile(line);
  return table_.Wrong(line.number,
                      "'" + kind +
                          "' found; NOD, REFUSE, LISTEN, USERDEF, BLINK, MOOD, LIFE or an "
                          "AUTO line (BLINK MOVE GAZE BREATH NODS SPEECH AVERT FACE) "
                          "expected");
}

}  // namespace

vm::Result<MotionTable> ReadMotions(const std::string& name, std::string_view text,
                                    const UnitNames& units) {
  return MotionReader(name, text, units).Read();
}

}  // namespace fsm
