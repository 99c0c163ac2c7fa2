#include "fsm/render/appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "embedded/appearance.h"

namespace fsm {
namespace {

constexpr std::pair<std::string_view, Material> kSurfaces[] = {
    {"skin", Material::kSkin},     {"lips", Material::kLip},
    {"teeth", Material::kTeeth},   {"gums", Material::kGum},
    {"tongue", Material::kTongue}, {"mouth_inside", Material::kMouthInside},
    {"cloth", Material::kCloth}};

std::string ConstantOf(const TableRow& row, std::size_t count) {
  const std::string type = count == 1 ? "float" : "vec" + std::to_string(count);
  std::string text = "const " + type + " look_" + row.key() + " = " + type + "(";
  for (std::size_t i = 1; i <= count; ++i) text += (i > 1 ? ", " : "") + row.Word(i);
  return text + ");\n";
}

}  // namespace

Appearance::Appearance(NumberTable numbers)
    : AppearanceNumbers(numbers), table_(std::move(numbers)) {
  for (const TableRow& row : table_.rows()) {
    const std::string name = NumberTable::RowName(row);
    if (name == row.key()) constants_ += ConstantOf(row, table_[name].size());
    if (name.ends_with(" direction") && std::ranges::count(table_[name], 0.0F) == 3)
      row.Fail("a lamp that stands nowhere");
  }
  for (const auto& [name, material] : kSurfaces) {
    Surface& surface = surfaces_[material];
    const auto get = [this, name](std::string_view property, auto& out) {
      table_.Get(fmt::format("{} {}", property, name), out);
    };
    get("wrap", surface.wrap);
    get("lobes", surface.lobes);
    get("key_through", surface.key_through);
    get("sheen", surface.sheen);
    get("saturation", surface.saturation);
    get("bump", surface.bump);
    get("detail_per_mm", surface.detail_per_mm);
  }
}

const Appearance& Appearance::BuiltIn() {
  static const Appearance table(NumberTable("tables/appearance.txt", embedded::appearance()));
  return table;
}

}  // namespace fsm
