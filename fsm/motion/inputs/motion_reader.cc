#include "fsm/motion/inputs/motion_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "fsm/motion/inputs/idle_kinds.h"
#include "fsm/motion/inputs/pattern_fields.h"

namespace fsm {
namespace {

constexpr std::size_t kMaxKeys = 100000;
constexpr std::string_view kAuto = "AUTO";  // prefix of lines with patterns of an IdleKind
constexpr std::array kBlinkFields = {PatternField{"CLOSING", &BlinkPattern::closing_ms},
                                     PatternField{"SHUT", &BlinkPattern::shut_ms},
                                     PatternField{"OPENING", &BlinkPattern::opening_ms, 1}};

void AddKey(const TableRow& row, std::vector<HeadCurve::Key>& keys) {
  if (row.size() != 4) row.Refuse("a key frame 'ms x y z' expected");
  HeadCurve::Key key;
  key.ms = row.Within<double>(0, 0, 86400000, "a time in ms");
  if (key.ms <= (keys.empty() ? 0 : keys.back().ms)) {
    row.Refuse(fmt::format("{:g} ms is not after the key before it", key.ms));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    key.angles[axis] = row.Within(1 + axis, -180, 180, "an angle in degrees");
  }
  if (keys.size() == kMaxKeys) row.Refuse("too many key frames");
  keys.push_back(key);
}

bool StartsWithNumber(const TableRow& row) { return ParseNumber(row.key()).has_value(); }

}  // namespace

vm::Result<HeadCurve> ReadMotionFile(const std::string& name, std::string_view text) {
  return ReadTable(name, text, [](const Table& table) {
    std::vector<HeadCurve::Key> keys;
    bool count_seen = false;
    for (const TableRow& row : table.rows()) {
      // Comments begin with // and may be in any encoding; any line that is not a number is a
      // comment too.
      if (!StartsWithNumber(row)) continue;
      if (!count_seen && row.size() == 1) {
        count_seen = true;
      } else {
        AddKey(row, keys);
      }
    }
    if (keys.empty()) table.Refuse("no key frame 'ms x y z' found");
    return HeadCurve(std::move(keys));
  });
}

namespace {

/// Reads the rows of a table of motions in order.
class MotionReader {
 public:
  MotionReader(const Table& table, const UnitNames& units) : rows_(table.rows()), units_(units) {}

  MotionPatterns Read() {
    while (next_ < rows_.size()) ReadRow(rows_[next_++]);
    return std::move(out_);
  }

 private:
  void ReadRow(const TableRow& row) {
    const std::string& kind = row.key();
    const auto idle = std::ranges::find_if(IdleKinds(), [&kind](const IdleKindRow& each) {
      return each.read != nullptr && kind.starts_with(kAuto) &&
             kind.substr(kAuto.size()) == each.name;
    });
    if (idle != IdleKinds().end()) {
      idle->read(row, units_, out_);
    } else if (kind == "NOD" || kind == "REFUSE" || kind == "LISTEN" || kind == "USERDEF") {
      ReadCurve(row);
    } else if (kind == "BLINK") {
      ReadPatternFields(row, out_.blinks, kBlinkFields);
    } else if (kind == "MOOD") {
      ReadMood(row);
    } else if (kind == "LIFE") {
      ReadProfile(row);
    } else {
      FailUnknown(row);
    }
  }

  [[noreturn]] static void FailUnknown(const TableRow& row) {
    std::string lines;
    for (const IdleKindRow& idle : IdleKinds()) {
      if (idle.read != nullptr) lines += fmt::format(", {}{}", kAuto, idle.name);
    }
    row.Refuse(fmt::format("'{}' found; NOD, REFUSE, LISTEN, USERDEF, BLINK, MOOD, LIFE{} expected",
                           row.key(), lines));
  }

  /// Also reads the key frames in the rows below this one.
  void ReadCurve(const TableRow& row) {
    auto& curves = out_.head[row.key()];
    CheckNextPattern(row, curves.size());
    std::vector<HeadCurve::Key> keys;
    while (next_ < rows_.size() && StartsWithNumber(rows_[next_])) AddKey(rows_[next_++], keys);
    if (keys.empty()) row.Refuse("key frames 'ms x y z' expected below");
    curves.emplace_back(std::move(keys));
  }

  void ReadMood(const TableRow& row) {
    if (row.size() < 3 || row.Word(1) == "NEUTRAL") {
      row.Refuse("MOOD NAME AU:WEIGHT ... expected, the name not NEUTRAL");
    }
    out_.moods[row.Word(1)] = ReadLook(row, 2, units_);
  }

  void ReadProfile(const TableRow& row) {
    if (row.size() < 2 || row.size() % 2 != 0) row.Refuse("LIFE NAME KIND PATTERN ... expected");
    IdleProfile profile{};
    for (std::size_t i = 2; i < row.size(); i += 2) {
      const auto kind = IdleKindNamed(row.Word(i));
      if (!kind) row.Refuse(fmt::format("'{}' found, a kind of Autonomous expected", row.Word(i)));
      const auto patterns = static_cast<double>(RowOf(*kind).count(out_));
      profile[static_cast<std::size_t>(*kind)] =
          static_cast<std::size_t>(row.Within<double>(i + 1, 0, patterns, "a pattern given above"));
    }
    out_.profiles[row.Word(1)] = profile;
  }

  const std::vector<TableRow>& rows_;
  const UnitNames& units_;
  std::size_t next_ = 0;  // index of the row after the current one
  MotionPatterns out_;
};

}  // namespace

vm::Result<MotionPatterns> ReadMotions(const std::string& name, std::string_view text,
                                       const UnitNames& units) {
  return ReadTable(name, text,
                   [&units](const Table& table) { return MotionReader(table, units).Read(); });
}

}  // namespace fsm
