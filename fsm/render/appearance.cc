#include "fsm/render/appearance.h"

#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "embedded/appearance.h"
#include "fsm/base/table_reader.h"

namespace fsm {
namespace {

constexpr std::pair<std::string_view, Material> kSurfaces[] = {
    {"skin", Material::kSkin},     {"lips", Material::kLip},
    {"teeth", Material::kTeeth},   {"gums", Material::kGum},
    {"tongue", Material::kTongue}, {"mouth_inside", Material::kMouthInside},
    {"cloth", Material::kCloth}};

/// What must stand in a table: "surface skin", "lamp key" or a name, and how many numbers follow.
using Entries = std::map<std::string, std::size_t>;

/// Words in front of a row's numbers.
std::size_t WordsOf(const TableRow& row) {
  return row.key() == "surface" || row.key() == "lamp" ? 2 : 1;
}

std::string EntryOf(const TableRow& row) {
  return WordsOf(row) == 2 ? row.key() + " " + row.Word(1) : row.key();
}

/// The names and counts of the built-in table.
const Entries& Known() {
  static const Entries known = [] {
    Entries entries;
    const Table table("tables/appearance.txt", embedded::appearance());
    for (const TableRow& row : table.rows()) entries[EntryOf(row)] = row.size() - WordsOf(row);
    return entries;
  }();
  return known;
}

/// The numbers of a row that is as the built-in table's is.
std::vector<float> NumbersOf(const TableRow& row) {
  constexpr float kMost = 1000;
  const auto known = Known().find(EntryOf(row));
  if (known == Known().end()) row.Fail("'" + EntryOf(row) + "' is not known");
  auto numbers = row.Numbers(WordsOf(row));
  if (numbers.size() != known->second) {
    row.Fail("'" + known->first + "' needs " + std::to_string(known->second) +
             " numbers after it, found " + std::to_string(numbers.size()));
  }
  for (const float number : numbers) {
    if (std::abs(number) > kMost) row.Fail("a number beyond -1000 to 1000");
  }
  return numbers;
}

std::string ConstantOf(const TableRow& row) {
  const std::size_t count = row.size() - 1;
  const std::string type = count == 1 ? "float" : "vec" + std::to_string(count);
  std::string text = "const " + type + " " + row.key() + " = " + type + "(";
  for (std::size_t i = 1; i <= count; ++i) text += (i > 1 ? ", " : "") + row.Word(i);
  return text + ");\n";
}

Appearance::Surface SurfaceOf(const std::vector<float>& n) {
  return {.wrap = {n[0], n[1], n[2]},
          .lobes = {n[3], n[4], n[5]},
          .key_through = n[6],
          .sheen = n[7],
          .saturation = n[8],
          .bump = n[9],
          .planar = n[10]};
}

}  // namespace

Appearance::Appearance(const std::string& name, std::string_view text) {
  std::set<std::string> seen;
  const Table table(name, text);
  for (const TableRow& row : table.rows()) {
    const auto n = NumbersOf(row);
    if (!seen.insert(EntryOf(row)).second) row.Fail("'" + EntryOf(row) + "' is there twice");
    if (row.key() == "lamp") {
      if (n[0] == 0 && n[1] == 0 && n[2] == 0) row.Fail("a lamp that stands nowhere");
      lamps_[row.Word(1)] = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    } else if (row.key() != "surface") {
      numbers_[row.key()] = n;
      constants_ += ConstantOf(row);
    } else {
      for (const auto& [word, material] : kSurfaces) {
        if (word == row.Word(1)) surfaces_[material] = SurfaceOf(n);
      }
    }
  }
  for (const auto& [entry, count] : Known()) {
    if (!seen.contains(entry)) throw std::runtime_error(name + ": '" + entry + "' is missing");
  }
}

const Appearance& Appearance::BuiltIn() {
  static const Appearance table("tables/appearance.txt", embedded::appearance());
  return table;
}

float Appearance::Number(const std::string& name) const { return numbers_.at(name).at(0); }

glm::vec3 Appearance::Color(const std::string& name) const {
  const auto& n = numbers_.at(name);
  return {n.at(0), n.at(1), n.at(2)};
}

glm::vec4 Appearance::ColorAndOpacity(const std::string& name) const {
  return {Color(name), numbers_.at(name).at(3)};
}

}  // namespace fsm
