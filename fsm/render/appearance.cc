#include "fsm/render/appearance.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "embedded/appearance.h"

namespace fsm {
namespace {

constexpr std::pair<std::string_view, Material> kSurfaces[] = {
    {"skin", Material::kSkin},     {"lips", Material::kLip},
    {"teeth", Material::kTeeth},   {"gums", Material::kGum},
    {"tongue", Material::kTongue}, {"mouth_inside", Material::kMouthInside},
    {"cloth", Material::kCloth}};

std::string ConstantOf(const std::string& name, const std::vector<float>& numbers) {
  const std::string type = numbers.size() == 1 ? "float" : fmt::format("vec{}", numbers.size());
  return fmt::format("const {0} look_{1} = {0}({2});\n", type, name, fmt::join(numbers, ", "));
}

}  // namespace

Appearance::Appearance(NumberTable numbers)
    : AppearanceNumbers(numbers), table_(std::move(numbers)) {
  for (const TableRow& row : table_.rows()) {
    const std::string name = NumberTable::RowName(row);
    if (name == row.key()) constants_ += ConstantOf(name, table_[name]);
    if (name.ends_with(" direction") && std::ranges::count(table_[name], 0.0f) == 3)
      row.Refuse("a lamp that stands nowhere");
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
