#include "fsm/head/identity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <stdexcept>

#include "embedded/identities.h"
#include "embedded/sliders.h"
#include "fsm/base/smooth_step.h"

namespace fsm {
namespace {

struct NamedColour {
  std::string_view name;
  glm::vec3 Palette::*colour;
};
constexpr std::array<NamedColour, 15> kColours = {{{"skin", &Palette::skin},
                                                   {"blush", &Palette::blush},
                                                   {"lip", &Palette::lip},
                                                   {"hair", &Palette::hair},
                                                   {"brow", &Palette::brow},
                                                   {"lash", &Palette::lash},
                                                   {"iris", &Palette::iris},
                                                   {"cloth", &Palette::cloth},
                                                   {"tooth", &Palette::tooth},
                                                   {"sclera", &Palette::sclera},
                                                   {"lip_inside", &Palette::lip_inside},
                                                   {"lid_rim", &Palette::lid_rim},
                                                   {"mouth", &Palette::mouth},
                                                   {"tongue", &Palette::tongue},
                                                   {"gum", &Palette::gum}}};

void ReadColour(const TableRow& row, Palette& palette) {
  const auto found = std::ranges::find(kColours, row.Word(1), &NamedColour::name);
  if (found == kColours.end()) row.Refuse("no part of a face is called " + row.Word(1));
  palette.*found->colour = {row.Within(2, 0, 1), row.Within(3, 0, 1), row.Within(4, 0, 1)};
  row.EndsAt(5);
}

Palette ReadBasePalette(const Table& table) {
  Palette palette;
  for (const TableRow& row : table.rows()) {
    if (row.key() == "face") break;
    ReadColour(row, palette);
  }
  return palette;
}

void ReadSlider(const TableRow& row, Identity& identity) {
  std::erase_if(identity.sliders, [&](const auto& other) { return other.first == row.Word(1); });
  identity.sliders.emplace_back(row.Word(1), row.Within(2, -kMaxSlider, kMaxSlider));
  row.EndsAt(3);
}

void ReadHair(const TableRow& row, Identity& identity) {
  if (row.Word(1) == "crop") {
    CropStyle crop{row.Within(2, -5, 60),
                   row.Within(3, -5, 60),
                   row.Integer(4),
                   row.Within(5, 0, 100),
                   row.Within(6, -2, 10),
                   row.Within(7, 0, 20),
                   row.Within(8, 0, 1),
                   row.Within(9, 0, 45),
                   row.size() > 10 ? row.Within(10, 0, 1) : 0.0f};
    if (crop.locks < 0 || crop.locks > 500) row.Refuse("0 to 500 locks");
    row.EndsAt(11);
    identity.hair = crop;
  } else if (row.Word(1) == "long") {
    LongStyle hanging{row.Within(2, -0.6f, 0.6f), row.Within(3, -5, 30), row.Within(4, -220, -20),
                      row.Within(5, -240, -20), row.Within(6, 0, 12)};
    if (row.size() > 7) hanging.tucked = row.Within(7, 0, 1);
    if (row.size() > 8) hanging.fringe_y = row.Within(8, 30, 90);
    row.EndsAt(9);
    identity.hair = hanging;
  } else if (row.Word(1) == "tied") {
    CombedStyle tied{.side_mm = row.Within(2, -5, 60),
                     .top_mm = row.Within(3, -5, 60),
                     .loose = row.Integer(6),
                     .tail = CombedStyle::Tail{row.Within(4, 10, 110), row.Within(5, -200, 0)}};
    if (tied.loose < 0 || tied.loose > 8) row.Refuse("0 to 8 loose strands");
    row.EndsAt(7);
    identity.hair = tied;
  } else if (row.Word(1) == "swept") {
    identity.hair = CombedStyle{.side_mm = row.Within(2, -5, 60),
                                .top_mm = row.Within(3, -5, 60),
                                .tail = {},
                                .wave_mm = row.Within(4, 0, 12),
                                .aside = row.Within(5, -1, 1)};
    row.EndsAt(6);
  } else {
    row.Refuse("long, crop, tied or swept expected");
  }
}

void ReadEyes(const TableRow& row, Identity& identity) {
  identity.eyes.size = row.Within(1, 0.7f, 1.4f);
  identity.eyes.roll = glm::radians(row.Within(2, -20, 20));
  identity.eyes.upper_mm = row.Within(3, -4, 3);
  identity.eyes.lower_mm = row.Within(4, -2, 4);
  row.EndsAt(5);
}

void ReadFold(const TableRow& row, Identity& identity) {
  identity.fold = {row.Within(1, -4, 4), row.Within(2, -4, 4), row.Within(3, 0, 2),
                   row.Within(4, -2, 5)};
  row.EndsAt(5);
}

void ReadBrows(const TableRow& row, Identity& identity) {
  identity.brows = {row.Within(1, 0, 3), row.Within(2, -8, 8)};
  if (row.size() > 3) identity.brows.arch = row.Within(3, -0.5f, 2);
  if (row.size() > 4) identity.brows.density = row.Within(4, 0, 1.5f);
  row.EndsAt(5);
}

void ReadCreases(const TableRow& row, Identity& identity) {
  for (std::size_t i = 0; i < kLastingCreases; ++i) identity.creases[i] = row.Within(i + 1, 0, 1);
  row.EndsAt(kLastingCreases + 1);
}

float OnlyNumber(const TableRow& row, float min, float max) {
  const float number = row.Within(1, min, max);
  row.EndsAt(2);
  return number;
}

/// The function that applies each kind of row to an identity, by key word.
const std::map<std::string_view, void (*)(const TableRow&, Identity&)> kIdentityRows = {
    {"colour", [](auto& row, auto& identity) { ReadColour(row, identity.palette); }},
    {"slider", ReadSlider},
    {"hair", ReadHair},
    {"eyes", ReadEyes},
    {"fold", ReadFold},
    {"beard", [](auto& row, auto& identity) { identity.palette.beard = OnlyNumber(row, 0, 1); }},
    {"lashes", [](auto& row, auto& identity) { identity.lashes = OnlyNumber(row, 0, 2); }},
    {"brows", ReadBrows},
    {"creases", ReadCreases},
    {"field", [](auto& row, auto& identity) { identity.units.Add(row); }},
    {"lid", [](auto& row, auto& identity) { identity.units.Add(row); }}};

void ReadIdentityRow(const TableRow& row, Identity& identity) {
  const auto found = kIdentityRows.find(row.key());
  if (found == kIdentityRows.end()) row.Refuse("unknown word '" + row.key() + "'");
  found->second(row, identity);
}

const Table& BuiltInTable() {
  static const Table table("tables/identities.txt", embedded::identities());
  return table;
}

/// Returns the index of a name in Identities(); throws std::runtime_error listing the names.
std::size_t IdentityIndex(std::string_view name) {
  const std::vector<std::string>& names = Identities();
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw std::runtime_error(
      fmt::format("there is no face '{}'; there is {}", name, fmt::join(names, ", ")));
}

}  // namespace

const Palette& BasePalette() {
  static const Palette palette = ReadBasePalette(BuiltInTable());
  return palette;
}

const std::vector<std::string>& Identities() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> found;
    for (const TableRow& row : BuiltInTable().rows()) {
      if (row.key() == "face") found.push_back(row.Word(1));
    }
    return found;
  }();
  return names;
}

bool IsBuiltIn(std::string_view name) {
  return std::ranges::find(Identities(), name) != Identities().end();
}

Identity BuiltInIdentity(std::string_view name) {
  Identity identity;
  identity.index = IdentityIndex(name);  // its error lists the names
  bool mine = false;
  for (const TableRow& row : BuiltInTable().rows()) {
    if (row.key() == "face") {
      mine = row.Word(1) == name;
    } else if (mine) {
      ReadIdentityRow(row, identity);
    }
  }
  return identity;
}

std::vector<std::string> SliderNames() {
  const Table table("tables/sliders.txt", embedded::sliders());
  std::vector<std::string> names;
  for (const TableRow& row : table.rows()) {
    if (std::ranges::find(names, row.Word(1)) == names.end()) names.push_back(row.Word(1));
  }
  return names;
}

Identity ReadOwnIdentity(const std::string& name, std::string_view text) {
  const Table table(name, text);
  const auto names = SliderNames();
  std::optional<Identity> identity;
  for (const TableRow& row : table.rows()) {
    if (row.key() == "base") {
      if (!IsBuiltIn(row.Word(1))) row.Refuse("no built-in face is called " + row.Word(1));
      if (identity) row.Refuse("a second base");
      identity = BuiltInIdentity(row.Word(1));
      continue;
    }
    if (!identity) row.Refuse("'base FACE' expected before it");
    if (row.key() == "slider" && std::ranges::find(names, row.Word(1)) == names.end()) {
      row.Refuse("no slider is called " + row.Word(1));
    }
    ReadIdentityRow(row, *identity);
  }
  if (!identity) table.Refuse("no line 'base FACE'");
  return *identity;
}

std::string WriteOwnIdentity(std::string_view base,
                             const std::map<std::string, float, std::less<>>& sliders) {
  std::string text =
      "# A face made of a built-in one; docs/face_editor.md.\nbase " + std::string(base) + "\n";
  for (const auto& [name, value] : sliders) text += fmt::format("slider {} {:.3g}\n", name, value);
  return text;
}

SliderWarp::SliderWarp(const Table& table,
                       const std::vector<std::pair<std::string, float>>& values) {
  for (const TableRow& row : table.rows()) {
    if (row.key() != "slider") row.Refuse("unknown word '" + row.key() + "'");
    const Field field{row.Vector(2), row.Vector(5), row.Vector(8)};
    if (field.radius.x <= 0 || field.radius.y <= 0 || field.radius.z <= 0) {
      row.Refuse("a radius must be positive");
    }
    for (const auto& [name, value] : values) {
      if (name == row.Word(1))
        fields_.push_back({field.centre, field.radius, value * field.displacement});
    }
  }
  for (const auto& [name, value] : values) {
    const bool known =
        std::ranges::any_of(table.rows(), [&](const TableRow& row) { return row.Word(1) == name; });
    if (!known) table.Refuse("no slider '" + name + "'");
  }
}

glm::vec3 SliderWarp::Motion(glm::vec3 p) const {
  glm::vec3 sum(0);
  for (const Field& field : fields_) {
    // The mirror image acts, too; its sideways component is reversed.
    for (const float image : {1.0f, -1.0f}) {
      if (image < 0 && field.centre.x == 0) continue;
      const glm::vec3 d = (glm::vec3(image * p.x, p.y, p.z) - field.centre) / field.radius;
      const float weight = Gaussian(glm::dot(d, d));
      sum += weight *
             glm::vec3(image * field.displacement.x, field.displacement.y, field.displacement.z);
    }
  }
  return sum;
}

}  // namespace fsm
