#include "fsm/render/appearance.h"

#include <utility>

#include "embedded/appearance.h"

namespace fsm {
namespace {

constexpr std::pair<std::string_view, Material> kSurfaces[] = {
    {"skin", Material::kSkin},     {"lips", Material::kLip},
    {"teeth", Material::kTeeth},   {"gums", Material::kGum},
    {"tongue", Material::kTongue}, {"mouth_inside", Material::kMouthInside},
    {"cloth", Material::kCloth}};

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

Appearance::Appearance(const std::string& name, std::string_view text)
    : Appearance(NumberTable(name, text, &BuiltIn().numbers_)) {}

Appearance::Appearance(NumberTable numbers) : numbers_(std::move(numbers)) {
  for (const TableRow& row : numbers_.rows()) {
    const auto& n = numbers_[NumberTable::NameOf(row)];
    if (row.key() == "lamp") {
      if (n[0] == 0 && n[1] == 0 && n[2] == 0) row.Fail("a lamp that stands nowhere");
      lamps_[row.Word(1)] = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    } else if (row.key() == "surface") {
      for (const auto& [word, material] : kSurfaces) {
        if (word == row.Word(1)) surfaces_[material] = SurfaceOf(n);
      }
    } else if (row.key() != "skin") {
      constants_ += ConstantOf(row);
    }
  }
}

const Appearance& Appearance::BuiltIn() {
  static const Appearance table(NumberTable("tables/appearance.txt", embedded::appearance()));
  return table;
}

float Appearance::Number(const std::string& name) const { return numbers_(name); }

glm::vec3 Appearance::Colour(const std::string& name) const { return numbers_.Vector(name); }

const std::vector<float>& Appearance::Skin(std::string_view name) const {
  return numbers_["skin " + std::string(name)];
}

glm::vec4 Appearance::ColourAndOpacity(const std::string& name) const {
  return {Colour(name), numbers_[name].at(3)};
}

}  // namespace fsm
