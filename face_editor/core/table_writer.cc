#include "face_editor/core/table_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <utility>
#include <vector>

#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "fsm/motion/base/unit_names.h"

namespace editor {
namespace {

/// A line of a table's file, taken apart the way fsm::Table does.
struct Line {
  std::string text;
  std::vector<std::string> words;
  std::string comment;  ///< with its #, and the blanks before it
};

std::vector<Line> TableLinesOf(std::string_view text) {
  std::vector<Line> lines;
  while (!text.empty()) {
    const std::size_t newline = text.find('\n');
    Line line{std::string(text.substr(0, newline)), {}, {}};
    text.remove_prefix(newline == std::string_view::npos ? text.size() : newline + 1);
    const fsm::Table table("", line.text);
    if (!table.rows().empty()) line.words = table.rows().front().words();
    for (std::size_t i = 0; i < line.text.size(); ++i) {
      const bool starts = i == 0 || line.text[i - 1] == ' ' || line.text[i - 1] == '\t';
      if (line.text[i] != '#' || !starts) continue;
      const std::size_t end = line.text.find_last_not_of(" \t", i == 0 ? 0 : i - 1);
      const std::size_t from = i == 0 || end == std::string::npos ? 0 : end + 1;
      line.comment = line.text.substr(from);
      break;
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string Joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

bool IsNumber(const Line& line) {
  return !line.words.empty() && fsm::ParseNumber(line.words[0]).has_value();
}

std::size_t PatternOf(const Line& line) {
  const auto number = line.words.size() > 1 ? fsm::ParseNumber(line.words[1]) : 0.0;
  return number && *number > 0 ? static_cast<std::size_t>(*number) : 0;
}

std::string TimingRow(const char* kind, const std::string& name,
                      const fsm::Expression::Timing& timing) {
  return fmt::format("{:<8} {:<9} {:g} {:g} {:g} {:g}", kind, name, timing.onset_ms,
                     timing.lag_ms[0], timing.lag_ms[1], timing.lag_ms[2]);
}

std::string PatternRow(const std::string& name, std::size_t pattern, const fsm::FaceLook& look,
                       const fsm::UnitNames& names) {
  return fmt::format("{} {:<3}{}", name, pattern,
                     std::string(std::max<std::size_t>(10, name.size()) - name.size(), ' ')) +
         fsm::FormatLook(look, names);
}

/// The last place a row of `name` stands at, one past it; the end if there is none.
std::size_t EndOf(const std::vector<std::pair<std::string, std::string>>& rows,
                  std::string_view name) {
  std::size_t end = rows.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].second == name) end = i + 1;
  }
  return end;
}

using Rows = std::vector<std::pair<std::string, std::string>>;  // text, and whose it is

std::string Joined(const Rows& rows) {
  std::vector<std::string> lines;
  for (const auto& row : rows) lines.push_back(row.first);
  return Joined(lines);
}

std::string KeyRow(const fsm::HeadCurve::Key& key) {
  return fmt::format("{:5g}  {:g} {:g} {:g}", key.ms, key.angles[0], key.angles[1], key.angles[2]);
}

bool Same(const fsm::HeadCurve& curve, const std::vector<Line>& lines, std::size_t first) {
  std::size_t at = first;
  for (const auto& key : curve.keys()) {
    while (at < lines.size() && lines[at].words.empty()) ++at;
    if (at == lines.size() || lines[at].words.size() != 4) return false;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto number = fsm::ParseNumber(lines[at].words[k]);
      const double wanted = k == 0 ? key.ms : static_cast<double>(key.angles[k - 1]);
      if (!number ||
          (k == 0 ? *number : static_cast<double>(static_cast<float>(*number))) != wanted) {
        return false;
      }
    }
    ++at;
  }
  while (at < lines.size() && lines[at].words.empty()) ++at;
  return at == lines.size() || !IsNumber(lines[at]);
}

}  // namespace

std::string WriteVisemes(std::string_view text, const fsm::Visemes& shapes) {
  std::vector<std::string> out;
  for (const Line& line : TableLinesOf(text)) {
    const fsm::Viseme* shape =
        line.words.empty() ? nullptr : fsm::FindViseme(shapes, line.words[0]);
    if (!shape) {
      out.push_back(line.text);
      continue;
    }
    fsm::Viseme old;
    const bool same = fsm::ReadVisemeValues(line.words, 1, old).has_value() &&
                      fsm::FormatVisemeValues(old) == fsm::FormatVisemeValues(*shape);
    out.push_back(same ? line.text
                       : fmt::format("{:<5} {}{}", shape->name, fsm::FormatVisemeValues(*shape),
                                     line.comment));
  }
  return Joined(out);
}

std::string WriteExpressions(std::string_view text, const fsm::ExpressionTable& expressions,
                             const fsm::UnitNames& names) {
  Rows rows;
  std::map<std::string, std::size_t, std::less<>> written;
  std::vector<std::pair<std::string, std::string>> timed;  // kind, name
  for (const Line& line : TableLinesOf(text)) {
    const bool timing =
        !line.words.empty() && (line.words[0] == "posed" || line.words[0] == "elicited");
    const bool growth =
        line.words.size() > 2 && (line.words[0] == "begins" || line.words[0] == "early");
    const std::string name = line.words.size() < 2 ? "" : line.words[timing || growth ? 1 : 0];
    const auto expression = expressions.find(name);
    if (line.words.size() < 2) {
      rows.emplace_back(line.text, "");
    } else if (expression == expressions.end()) {
      continue;  // it is gone
    } else if (timing) {
      const bool posed = line.words[0] == "posed";
      const std::string row =
          TimingRow(posed ? "posed" : "elicited", name,
                    posed ? expression->second.posed : expression->second.elicited);
      const bool same = fsm::Table("", row).rows().front().words() == line.words;
      rows.emplace_back(same ? line.text : row + line.comment, "");
      timed.emplace_back(line.words[0], name);
    } else if (growth) {
      const auto pattern = fsm::ParseNumber(line.words[2]);
      const auto count = static_cast<double>(expression->second.patterns.size());
      if (pattern && *pattern <= count) rows.emplace_back(line.text, name);
    } else {
      const std::size_t pattern = PatternOf(line);
      if (pattern == 0 || pattern > expression->second.patterns.size()) continue;
      const fsm::FaceLook& look = expression->second.patterns[pattern - 1];
      const auto old = fsm::ReadTable("", line.text, [&names](const fsm::Table& table) {
        return fsm::ReadLook(table.rows().front(), 2, names);
      });
      const bool same = old && fsm::FormatLook(*old, names) == fsm::FormatLook(look, names);
      rows.emplace_back(same ? line.text : PatternRow(name, pattern, look, names) + line.comment,
                        name);
      written[name] = pattern;
    }
  }
  for (const auto& [name, expression] : expressions) {
    const bool is_new = written[name] == 0;
    for (const auto& [kind, timing] :
         {std::pair("posed", &expression.posed), std::pair("elicited", &expression.elicited)}) {
      // Times that nothing was said of are those of a new expression anyway.
      const bool told = std::ranges::find(timed, std::pair(std::string(kind), name)) != timed.end();
      const bool plain = TimingRow(kind, name, {}) == TimingRow(kind, name, *timing);
      if (!told && !plain) rows.emplace_back(TimingRow(kind, name, *timing), "");
    }
    if (is_new) rows.emplace_back("", "");
    for (std::size_t p = written[name]; p < expression.patterns.size(); ++p) {
      const auto end = static_cast<std::ptrdiff_t>(EndOf(rows, name));
      rows.insert(rows.begin() + end,
                  {PatternRow(name, p + 1, expression.patterns[p], names), name});
    }
  }
  return Joined(rows);
}

std::string WriteCurves(std::string_view text, const HeadCurves& curves) {
  const std::vector<Line> lines = TableLinesOf(text);
  Rows rows;
  std::map<std::string, std::size_t, std::less<>> written;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& line = lines[i];
    const auto kind = line.words.empty() ? curves.end() : curves.find(line.words[0]);
    if (kind == curves.end()) {
      rows.emplace_back(line.text, "");
      continue;
    }
    const std::size_t pattern = PatternOf(line);
    std::size_t end = i + 1;  // of its key frames
    for (std::size_t k = i + 1; k < lines.size() && (lines[k].words.empty() || IsNumber(lines[k]));
         ++k) {
      if (IsNumber(lines[k])) end = k + 1;
    }
    const bool gone = pattern == 0 || pattern > kind->second.size();
    if (!gone) {
      const fsm::HeadCurve& curve = kind->second[pattern - 1];
      rows.emplace_back(line.text, kind->first);
      if (Same(curve, lines, i + 1)) {
        for (std::size_t k = i + 1; k < end; ++k) rows.emplace_back(lines[k].text, kind->first);
      } else {
        for (const auto& key : curve.keys()) rows.emplace_back(KeyRow(key), kind->first);
      }
      written[kind->first] = pattern;
    }
    i = end - 1;
  }
  for (const auto& [kind, patterns] : curves) {
    for (std::size_t p = written[kind]; p < patterns.size(); ++p) {
      auto end = static_cast<std::ptrdiff_t>(EndOf(rows, kind));
      rows.insert(rows.begin() + end++, {fmt::format("{} {}", kind, p + 1), kind});
      for (const auto& key : patterns[p].keys()) {
        rows.insert(rows.begin() + end++, {KeyRow(key), kind});
      }
    }
  }
  return Joined(rows);
}

}  // namespace editor
