#include "fsm/head/own_identity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "embedded/identities.h"
#include "embedded/sliders.h"

namespace fsm {

Identity BuiltInIdentity(std::string_view name) {
  return ReadIdentity(Table("tables/identities.txt", embedded::identities()), name);
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
      const auto known = std::ranges::find(Identities(), row.Word(1), &IdentityInfo::name);
      if (known == Identities().end()) row.Fail("no built-in face is called " + row.Word(1));
      if (identity) row.Fail("a second base");
      identity = BuiltInIdentity(row.Word(1));
      continue;
    }
    if (!identity) row.Fail("'base FACE' expected before it");
    if (row.key() == "slider") {
      if (std::ranges::find(names, row.Word(1)) == names.end()) {
        row.Fail("no slider is called " + row.Word(1));
      }
      if (!(std::abs(row.Number(2)) <= kMostSlider)) row.Fail("-10 to 10 expected");
    }
    ReadIdentityRow(row, *identity);
  }
  if (!identity) table.Fail("no line 'base FACE'");
  return *identity;
}

std::string WriteOwnIdentity(std::string_view base,
                             const std::map<std::string, float, std::less<>>& sliders) {
  std::string text =
      "# A face made of a built-in one; docs/face_editor.md.\nbase " + std::string(base) + "\n";
  std::array<char, 80> line;
  for (const auto& [name, value] : sliders) {
    std::snprintf(line.data(), line.size(), "slider %s %.3g\n", name.c_str(),
                  static_cast<double>(value));
    text += line.data();
  }
  return text;
}

}  // namespace fsm
