#include "fsm/render/appearance.h"

#include <utility>

#include "embedded/appearance.h"

namespace fsm {
namespace {

constexpr std::pair<const char*, Material> kSurfaces[] = {
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

}  // namespace

Appearance::Appearance(NumberTable numbers) : NumberTable(std::move(numbers)) {
  for (const TableRow& row : rows()) {
    const std::string name = NameOf(row);
    if (name == row.key()) constants_ += ConstantOf(row);
    if (name.ends_with(" direction") && Vector(name) == glm::vec3(0))
      row.Fail("a lamp that stands nowhere");
  }
  for (const auto& [name, material] : kSurfaces) {
    const auto row = [name](const char* property) { return std::string(property) + " " + name; };
    surfaces_[material] = {.wrap = Vector(row("wrap")),
                           .lobes = Vector(row("lobes")),
                           .key_through = (*this)(row("key_through")),
                           .sheen = (*this)(row("down")),
                           .saturation = (*this)(row("saturation")),
                           .bump = (*this)(row("bump")),
                           .planar = (*this)(row("repeats"))};
  }
}

const Appearance& Appearance::BuiltIn() {
  static const Appearance table(NumberTable("tables/appearance.txt", embedded::appearance()));
  return table;
}

Appearance::Lamp Appearance::lamp(const std::string& name) const {
  return {Vector("lamp " + name + " direction"), Vector("lamp " + name + " light")};
}

}  // namespace fsm
