// The page of units' fields: how far each unit moves which skin, lids, jaw and tongue.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "face_editor/app/ui.h"
#include "fsm/base/parse_number.h"
#include "fsm/motion/base/unit_names.h"
#include "fsm/render/camera.h"

namespace editor {
namespace {

/// What the columns are called on the page; those of a field are named in its own lines.
const char* LabelOf(std::string_view kind, std::string_view column) {
  if (kind == "lid") return column == "upper" ? "upper edge up, mm" : "lower edge up, mm";
  if (kind == "close") return "how far, 1 = wholly";
  if (kind == "jaw") return column == "degrees" ? "opening, degrees" : "forward, mm";
  if (kind == "sway") return "to its own side, mm";
  if (kind == "seal") return "whatever the jaw does";
  if (kind == "tongue") return column == "raise" ? "tip raised" : "put out, mm";
  if (kind == "crease") return column.data();  // a literal
  return "by this part";
}

/// A number of a row as a slider; its name for scripts is "row N COLUMN".
void Number(Ui& ui, int row, const UnitRow& what, std::size_t word, const UnitColumn& column,
            float width, const char* label) {
  const auto value = fsm::ParseNumber(what.words[word]);
  auto number = static_cast<float>(value.value_or(0));
  // Shares of one are finer than millimetres and degrees.
  const float step = column.high - column.low <= 2 ? 0.01F : 0.1F;
  const std::string id = fmt::format("##row {} {}", row, column.name);
  ImGui::SetNextItemWidth(width);
  const bool moved =
      Slider(ui, id.c_str(), &number, column.low, column.high, step < 0.1F ? "%.2f" : "%.1f");
  if (moved) {
    const double rounded =
        std::round(static_cast<double>(number / step)) * static_cast<double>(step);
    ui.Check(ui.editor.SetRow(ui.field_unit, row, column.name,
                              fmt::format("{:.4g}", std::abs(rounded) < 1e-6 ? 0 : rounded),
                              fmt::format("{} {}", ui.field_unit, id)));
  }
  if (*label == '\0') return;
  ImGui::SameLine();
  ImGui::TextUnformatted(label);
}

void Side(Ui& ui, int row, const std::string& now) {
  static const std::vector<std::string> sides{"both", "above", "below"};
  std::string side = now;
  ImGui::SetNextItemWidth(90);
  if (Choice(ui, fmt::format("##row {} part", row).c_str(), &side, sides)) {
    ui.Check(ui.editor.SetRow(ui.field_unit, row, "part", side));
  }
}

/// at A B, reaching ALONG DOWN of PART, by X Y Z.
void Field(Ui& ui, int row, const UnitRow& what, const UnitRowKind& kind) {
  constexpr float kWide = 84, kIndent = 76;
  const auto line = [&](const char* title, std::size_t first, std::size_t count) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", title);
    for (std::size_t i = first; i < first + count; ++i) {
      ImGui::SameLine(i == first ? kIndent : 0);
      Number(ui, row, what, kind.first + i, kind.columns[i], kWide, "");
    }
  };
  line("around", 0, 2);
  ImGui::SameLine();
  ImGui::TextDisabled("out, up, mm");
  line("reaching", 2, 2);
  ImGui::SameLine();
  Side(ui, row, what.words[kind.first + 4]);
  line("moves", 5, 3);
  ImGui::SameLine();
  ImGui::TextDisabled("out, up, fore");
}

/// A row of the table; false if it is gone.
bool Row(Ui& ui, int row, const UnitRow& what) {
  const UnitRowKind& kind = *KindOf(what);
  ImGui::PushID(row);
  ImGui::BeginGroup();
  ImGui::AlignTextToFramePadding();
  const std::string other = kind.first > 2 ? " " + what.words[2] : "";
  ImGui::Text("%d  %s%s", row, std::string(kind.meaning).c_str(), other.c_str());
  ImGui::SameLine(ImGui::GetWindowWidth() - 100);
  const bool removed = Button(ui, fmt::format("Remove##{}", row).c_str());
  Mark(ui, fmt::format("remove row {}", row).c_str());
  if (kind.word == "field") {
    Field(ui, row, what, kind);
  } else {
    // The last number of a crease may be left out.
    const std::size_t count = std::min(kind.columns.size(), what.words.size() - kind.first);
    for (std::size_t i = 0; i < count; ++i) {
      Number(ui, row, what, kind.first + i, kind.columns[i], 180,
             LabelOf(kind.word, kind.columns[i].name));
    }
  }
  ImGui::EndGroup();
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  if (ImGui::IsMouseHoveringRect(low, high) && kind.word == "field") ui.field_row = row;
  ImGui::Separator();
  ImGui::PopID();
  if (removed) ui.Check(ui.editor.RemoveRow(ui.field_unit, row));
  return !removed;
}

void ChooseUnit(Ui& ui) {
  const auto& names = ui.editor.unit_names().names;
  const auto title = [&](int unit) {
    const auto name = names.find(unit);
    return fmt::format("{} {}", unit, name == names.end() ? "" : Spaced(name->second));
  };
  std::vector<std::string> titles;
  for (int unit = 1; unit < static_cast<int>(fsm::kActionUnits); ++unit) {
    if (fsm::UnitNames::BuiltIn().IsUnit(unit)) titles.push_back(title(unit));
  }
  std::string chosen = title(ui.field_unit);
  ImGui::SetNextItemWidth(230);
  if (Choice(ui, "##unit", &chosen, titles)) ui.field_unit = std::stoi(chosen);
  ImGui::SameLine();
  Checkbox(ui, "right", &ui.field_sides.right, "Shown on the agent's right side");
  ImGui::SameLine();
  Checkbox(ui, "left", &ui.field_sides.left, "Shown on the agent's left side");
  ImGui::SetNextItemWidth(230);
  Slider(ui, "shown at, per cent", &ui.field_percent, 0, 200, "%.0f");
}

void NewRow(Ui& ui) {
  std::vector<std::string> words;
  for (const UnitRowKind& kind : UnitRowKinds()) words.emplace_back(kind.word);
  ImGui::SetNextItemWidth(130);
  Choice(ui, "##new row", &ui.field_word, words);
  ImGui::SameLine();
  if (Button(ui, "Add row", true, "Another row for this unit, to be set")) {
    ui.Check(ui.editor.AddRow(ui.field_unit, ui.field_word));
  }
}

fsm::FaceState Shown(const Ui& ui, float strength) {
  fsm::FaceState state;
  const auto unit = static_cast<std::size_t>(ui.field_unit);
  if (ui.field_sides.right) state.au.right[unit] = strength;
  if (ui.field_sides.left) state.au.left[unit] = strength;
  return state;
}

}  // namespace

void DrawTouched(Ui& ui, ImVec2 low, ImVec2 size) {
  const auto& units = *ui.editor.state().units;
  const auto rows = RowsOf(units.rows, ui.field_unit);
  const auto row = static_cast<std::size_t>(ui.field_row);
  if (row < 1 || row > rows.size()) return;
  const auto alone = WithRows(units, {units.rows[rows[row - 1]]});
  if (!alone) return;
  fsm::Figure turned;
  turned.rotation = {ui.stage.turn[0], ui.stage.turn[1], 0};
  const fsm::FrameCamera view =
      fsm::ViewOfPortrait(turned, ui.stage.scene.camera, ui.preview.width, ui.preview.height,
                          ui.stage.head() ? ui.stage.head()->view() : std::nullopt);
  const auto touched =
      ui.stage.TouchedBy((*alone)->table, Shown(ui, 1), Shown(ui, ui.field_percent / 100));
  float most = 0;
  for (const auto& place : touched) most = std::max(most, place.by);
  for (const auto& place : touched) {
    const glm::vec4 clip = view.world_to_clip * view.figure_to_world * glm::vec4(place.at, 1.0F);
    const ImVec2 at{low.x + size.x * (0.5F + 0.5F * clip.x / clip.w),
                    low.y + size.y * (0.5F - 0.5F * clip.y / clip.w)};
    const int alpha = static_cast<int>(40 + 200 * place.by / most);
    ImGui::GetWindowDrawList()->AddCircleFilled(at, 1.7F, IM_COL32(255, 210, 60, alpha));
  }
}

fsm::FaceState FieldsPage(Ui& ui) {
  ChooseUnit(ui);
  ui.field_row = 0;
  Heading("On the left side of the face; the right is its mirror image");
  ImGui::BeginChild("rows", {0, std::max(ImGui::GetContentRegionAvail().y - 110, 150.0F)});
  const auto units = ui.editor.state().units;  // a row may go while they are drawn
  int number = 0;
  for (const std::size_t i : RowsOf(units->rows, ui.field_unit)) {
    if (!Row(ui, ++number, units->rows[i])) break;
  }
  if (number == 0) ImGui::TextDisabled("Nothing yet.");
  ImGui::EndChild();
  NewRow(ui);
  FileRow(ui, Part::kUnits, "action_units.txt");
  return Shown(ui, ui.field_percent / 100);
}

}  // namespace editor
