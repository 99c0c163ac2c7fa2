#include "fsm/motion/motion_reader.h"

#include <fmt/format.h>

#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"

namespace fsm {
namespace {

constexpr std::size_t kMaxKeys = 100000;

void AddKey(const TableRow& row, std::vector<HeadCurve::Key>& keys) {
  if (row.size() != 4) row.Fail("a key frame 'ms x y z' expected");
  HeadCurve::Key key;
  key.ms = row.Number(0, "a time in ms", 0, 86400000);
  if (key.ms <= (keys.empty() ? 0 : keys.back().ms)) {
    row.Fail(fmt::format("{:g} ms is not after the key before it", key.ms));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    key.angles[axis] = static_cast<float>(row.Number(1 + axis, "an angle in degrees", -180, 180));
  }
  if (keys.size() == kMaxKeys) row.Fail("too many key frames");
  keys.push_back(key);
}

bool StartsWithNumber(const TableRow& row) { return ParseNumber(row.key()).has_value(); }

}  // namespace

vm::Result<HeadCurve> ReadMotionFile(const std::string& name, std::string_view text) {
  return ReadTable(name, text, [](const Table& table) {
    std::vector<HeadCurve::Key> keys;
    bool count_seen = false;
    for (const TableRow& row : table.rows()) {
      // Comments begin with // and are in any encoding; a line that is no number is one too.
      if (!StartsWithNumber(row)) continue;
      if (!count_seen && row.size() == 1) {
        count_seen = true;
      } else {
        AddKey(row, keys);
      }
    }
    if (keys.empty()) table.Fail("no key frame 'ms x y z' found");
    return HeadCurve(std::move(keys));
  });
}

namespace {

/// Reads the rows of a table of motions, one after the other.
class MotionReader {
 public:
  MotionReader(const Table& table, const UnitNames& units) : rows_(table.rows()), units_(units) {}

  MotionPatterns Read() {
    while (next_ < rows_.size()) ReadRow(rows_[next_++]);
    return std::move(out_);
  }

 private:
  using Numbers = std::vector<double>;

  void ReadRow(const TableRow& row) {
    const std::string& kind = row.key();
    if (kind == "NOD" || kind == "REFUSE" || kind == "LISTEN" || kind == "USERDEF") {
      ReadCurve(row);
    } else if (kind == "BLINK") {
      ReadPattern(row, out_.blinks, "BLINK PATTERN CLOSING SHUT OPENING, ms,", 1,
                  &BlinkPattern::closing_ms, &BlinkPattern::shut_ms, &BlinkPattern::opening_ms);
    } else if (kind == "AUTOBLINK") {
      ReadBlinks(row);
    } else if (kind == "AUTOMOVE") {
      ReadMove(row);
    } else if (kind == "AUTOGAZE") {
      ReadPattern(row, out_.auto_gazes, "AUTOGAZE PATTERN ANGLE INTERVAL, at least 200 ms,", 200,
                  &AutoGaze::amplitude, &AutoGaze::interval_ms);
    } else if (kind == "AUTOBREATH") {
      ReadPattern(row, out_.auto_breaths, "AUTOBREATH PATTERN PITCH PERIOD, at least 500 ms,", 500,
                  &AutoBreath::pitch, &AutoBreath::period_ms);
    } else if (kind == "AUTONODS") {
      ReadPattern(row, out_.auto_nods, "AUTONODS PATTERN ANGLE INTERVAL, at least 2000 ms,", 2000,
                  &AutoNods::angle, &AutoNods::interval_ms);
    } else if (kind == "AUTOSPEECH") {
      ReadPattern(row, out_.auto_speeches, "AUTOSPEECH PATTERN NOD TURN TILT BROW", 0,
                  &AutoSpeech::nod, &AutoSpeech::turn, &AutoSpeech::tilt, &AutoSpeech::brow);
    } else if (kind == "AUTOAVERT") {
      ReadPattern(row, out_.auto_averts, "AUTOAVERT PATTERN ANGLE SHORTEST", 0, &AutoAvert::angle,
                  &AutoAvert::shortest_ms);
    } else if (kind == "AUTOTEXT") {
      ReadPattern(row, out_.auto_texts, "AUTOTEXT PATTERN SIZE", 0, &AutoText::size);
    } else if (kind == "AUTOFACE") {
      CheckPattern(row, out_.auto_faces.size());
      out_.auto_faces.push_back(ReadUnits(row, 2, units_));
    } else if (kind == "MOOD") {
      ReadMood(row);
    } else if (kind == "LIFE") {
      ReadProfile(row);
    } else {
      row.Fail("'" + kind +
               "' found; NOD, REFUSE, LISTEN, USERDEF, BLINK, MOOD, LIFE or an AUTO line (BLINK "
               "MOVE GAZE BREATH NODS SPEECH AVERT FACE TEXT) expected");
    }
  }

  static void CheckPattern(const TableRow& row, std::size_t have) {
    const double pattern = row.Number(1, "a pattern number", 1, 10000);
    if (pattern != static_cast<double>(have + 1)) {
      row.Fail(fmt::format("pattern {:g} found, {} expected next", pattern, have + 1));
    }
  }

  /// The `count` numbers behind the pattern's number, which must be the next one. None is below 0,
  /// and the last is at least `least`.
  static Numbers ReadNumbers(const TableRow& row, std::size_t have, std::size_t count,
                             const std::string& expected, double least = 0) {
    CheckPattern(row, have);
    if (row.size() != count + 2) row.Fail(expected + " expected");
    Numbers numbers;
    for (std::size_t i = 0; i < count; ++i) {
      numbers.push_back(row.Number(2 + i, expected, i + 1 == count ? least : 0, 3600000));
    }
    return numbers;
  }

  /// A pattern of which each number is one field.
  template <typename Pattern, typename... Fields>
  static void ReadPattern(const TableRow& row, std::vector<Pattern>& patterns,
                          const std::string& expected, double least, Fields... fields) {
    const Numbers numbers = ReadNumbers(row, patterns.size(), sizeof...(fields), expected, least);
    Pattern& pattern = patterns.emplace_back();
    auto next = numbers.begin();
    ((pattern.*fields = *next++), ...);
  }

  /// Reads the key frames in the rows below this one, too.
  void ReadCurve(const TableRow& row) {
    auto& curves = out_.head[row.key()];
    CheckPattern(row, curves.size());
    std::vector<HeadCurve::Key> keys;
    while (next_ < rows_.size() && StartsWithNumber(rows_[next_])) AddKey(rows_[next_++], keys);
    if (keys.empty()) row.Fail("key frames 'ms x y z' expected below");
    curves.emplace_back(std::move(keys));
  }

  void ReadMood(const TableRow& row) {
    if (row.size() < 3 || row.Word(1) == "NEUTRAL") {
      row.Fail("MOOD NAME AU:WEIGHT ... expected, the name not NEUTRAL");
    }
    out_.moods[row.Word(1)] = ReadUnits(row, 2, units_);
  }

  void ReadProfile(const TableRow& row) {
    if (row.size() < 2 || row.size() % 2 != 0) row.Fail("LIFE NAME KIND PATTERN ... expected");
    IdleProfile profile{};
    for (std::size_t i = 2; i < row.size(); i += 2) {
      const auto kind = IdleKindNamed(row.Word(i));
      if (!kind) row.Fail(fmt::format("'{}' found, a kind of Autonomous expected", row.Word(i)));
      const auto patterns = static_cast<double>(out_.Count(*kind));
      profile[static_cast<std::size_t>(*kind)] =
          static_cast<std::size_t>(row.Number(i + 1, "a pattern given above", 0, patterns));
    }
    out_.profiles[row.Word(1)] = profile;
  }

  void ReadBlinks(const TableRow& row) {
    const Numbers v =
        ReadNumbers(row, out_.auto_blinks.size(), 2, "AUTOBLINK PATTERN INTERVAL BLINK");
    if (v[0] < 500 || v[1] < 1 || v[1] > static_cast<double>(out_.blinks.size())) {
      row.Fail("an interval of at least 500 ms and a blink above expected");
    }
    out_.auto_blinks.push_back({v[0], static_cast<std::size_t>(v[1]) - 1, true});
  }

  void ReadMove(const TableRow& row) {
    const Numbers v = ReadNumbers(row, out_.auto_moves.size(), 4,
                                  "AUTOMOVE PATTERN X Y Z PERIOD, at least 100 ms,", 100);
    AutoMove move{.period_ms = v[3]};
    for (std::size_t axis = 0; axis < 3; ++axis) move.amplitude[axis] = static_cast<float>(v[axis]);
    out_.auto_moves.push_back(move);
  }

  const std::vector<TableRow>& rows_;
  const UnitNames& units_;
  std::size_t next_ = 0;  // the row after the one in hand
  MotionPatterns out_;
};

}  // namespace

vm::Result<MotionPatterns> ReadMotions(const std::string& name, std::string_view text,
                                       const UnitNames& units) {
  return ReadTable(name, text,
                   [&units](const Table& table) { return MotionReader(table, units).Read(); });
}

}  // namespace fsm
