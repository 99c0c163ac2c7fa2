#include "fsm/motion/motion_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "fsm/motion/table_text.h"

namespace fsm {

HeadCurve::HeadCurve(std::vector<Key> keys) : keys_(std::move(keys)) {
  keys_.insert(keys_.begin(), Key{});
  assert(keys_.size() >= 2);
  slopes_.resize(keys_.size());
  for (std::size_t i = 1; i + 1 < keys_.size(); ++i) {
    const double before = keys_[i].ms - keys_[i - 1].ms;
    const double after = keys_[i + 1].ms - keys_[i].ms;
    assert(before > 0 && after > 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double a = (keys_[i].angles[axis] - keys_[i - 1].angles[axis]) / before;
      const double b = (keys_[i + 1].angles[axis] - keys_[i].angles[axis]) / after;
      if (a * b <= 0) continue;  // a turning point
      const double wa = 2 * after + before;
      const double wb = after + 2 * before;
      slopes_[i][axis] = static_cast<float>((wa + wb) / (wa / a + wb / b));
    }
  }
}

Angles HeadCurve::At(double ms) const {
  if (ms <= 0) return keys_.front().angles;
  if (ms >= keys_.back().ms) return keys_.back().angles;
  const auto next = std::ranges::upper_bound(keys_, ms, {}, &Key::ms);
  const auto i = static_cast<std::size_t>(next - keys_.begin()) - 1;
  const double span = keys_[i + 1].ms - keys_[i].ms;
  const double u = (ms - keys_[i].ms) / span;
  Angles out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double p0 = keys_[i].angles[axis];
    const double p1 = keys_[i + 1].angles[axis];
    const double m0 = slopes_[i][axis] * span;
    const double m1 = slopes_[i + 1][axis] * span;
    // The cubic Hermite polynomial.
    out[axis] = static_cast<float>(
        p0 + u * (m0 + u * (3 * (p1 - p0) - 2 * m0 - m1 + u * (2 * (p0 - p1) + m0 + m1))));
  }
  return out;
}

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

vm::Result<std::vector<double>> Numbers(const TableText& table, const TableLine& line,
                                        std::size_t count, const std::string& expected) {
  if (line.words.size() != count + 1) return table.Wrong(line.number, expected + " expected");
  std::vector<double> numbers;
  for (std::size_t i = 1; i <= count; ++i) {
    const auto number = table.Number(line, i, expected, 0, 3600000);
    if (!number) return std::unexpected(number.error());
    numbers.push_back(*number);
  }
  return numbers;
}

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

vm::Result<MotionTable> ReadMotions(const std::string& name, std::string_view text) {
  const TableText table(name, text);
  MotionTable out;
  const auto& lines = table.lines();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const TableLine& line = lines[i];
    const std::string& kind = line.words[0];
    const auto check_pattern = [&](std::size_t have) -> vm::Result<void> {
      const auto pattern = table.Number(line, 1, "a pattern number", 1, 10000);
      if (!pattern) return std::unexpected(pattern.error());
      if (*pattern != static_cast<double>(have + 1)) {
        return table.Wrong(line.number,
                           fmt::format("pattern {:g} found, {} expected next", *pattern, have + 1));
      }
      return {};
    };
    const auto read = [&](std::size_t have, std::size_t count,
                          const std::string& expected) -> vm::Result<std::vector<double>> {
      if (auto fits = check_pattern(have); !fits) return std::unexpected(fits.error());
      return Numbers(table, line, count, expected);
    };
    if (kind == "NOD" || kind == "REFUSE" || kind == "LISTEN" || kind == "USERDEF") {
      if (auto fits = check_pattern(out.head[kind].size()); !fits) {
        return std::unexpected(fits.error());
      }
      std::vector<HeadCurve::Key> keys;
      while (i + 1 < lines.size() && StartsWithNumber(lines[i + 1])) {
        const auto key = ReadKey(table, lines[++i], keys.empty() ? 0 : keys.back().ms);
        if (!key) return std::unexpected(key.error());
        keys.push_back(*key);
      }
      if (keys.empty()) return table.Wrong(line.number, "key frames 'ms x y z' expected below");
      out.head[kind].emplace_back(std::move(keys));
    } else if (kind == "BLINK") {
      const auto v = read(out.blinks.size(), 4, "BLINK PATTERN CLOSING SHUT OPENING");
      if (!v) return std::unexpected(v.error());
      out.blinks.push_back({(*v)[1], (*v)[2], (*v)[3]});
    } else if (kind == "AUTOBLINK") {
      const auto v = read(out.auto_blinks.size(), 3, "AUTOBLINK PATTERN INTERVAL BLINK");
      if (!v) return std::unexpected(v.error());
      if ((*v)[1] < 500 || (*v)[2] < 1 || (*v)[2] > static_cast<double>(out.blinks.size())) {
        return table.Wrong(line.number,
                           "an interval of at least 500 ms and a blink above expected");
      }
      out.auto_blinks.push_back({(*v)[1], static_cast<std::size_t>((*v)[2]) - 1, true});
    } else if (kind == "AUTOMOVE") {
      const auto v = read(out.auto_moves.size(), 5, "AUTOMOVE PATTERN X Y Z PERIOD");
      if (!v) return std::unexpected(v.error());
      if ((*v)[4] < 100) return table.Wrong(line.number, "a period of at least 100 ms expected");
      out.auto_moves.push_back(
          {{static_cast<float>((*v)[1]), static_cast<float>((*v)[2]), static_cast<float>((*v)[3])},
           (*v)[4]});
    } else if (kind == "AUTOGAZE") {
      const auto v = read(out.auto_gazes.size(), 3, "AUTOGAZE PATTERN ANGLE INTERVAL");
      if (!v) return std::unexpected(v.error());
      if ((*v)[2] < 200) return table.Wrong(line.number, "an interval of at least 200 ms expected");
      out.auto_gazes.push_back({(*v)[1], (*v)[2]});
    } else {
      return table.Wrong(line.number,
                         "'" + kind +
                             "' found; NOD, REFUSE, LISTEN, USERDEF, BLINK, AUTOBLINK, AUTOMOVE or "
                             "AUTOGAZE expected");
    }
  }
  return out;
}

}  // namespace fsm
