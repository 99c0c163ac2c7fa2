#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "face_editor/core/history.h"
#include "face_editor/core/photo_work.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "vm_protocol/core/result.h"

namespace editor {

/// What is open and what can be done to it; pages and scripts do the same things here. No window,
/// no time. Everything that changes the state can be undone; opening a file cannot.
/// Errors: kBadValue with what was expected, kUnavailable for files; then nothing has changed.
class Editor {
 public:
  /// `tables`: a folder of tables in place of the built-in ones, "" = none.
  static vm::Result<std::unique_ptr<Editor>> Make(const std::string& tables);

  const State& state() const { return history_.now(); }
  History& history() { return history_; }
  const History& history() const { return history_; }
  /// The tables as they are edited now.
  fsm::MotionTables Tables() const;
  const fsm::UnitNames& unit_names() const { return tables_.unit_names; }
  const fsm::UnitRegions& unit_regions() const { return tables_.unit_list.regions; }
  bool Unsaved(Part part) const;
  /// "points mouth": what is kept in files and has been changed since; "" if nothing.
  std::string UnsavedNames() const;

  // The photo.
  void SetModels(std::shared_ptr<FaceModels> models) { models_ = std::move(models); }
  vm::Result<void> OpenPhoto(const std::string& path, int face = 1);
  const std::shared_ptr<const PhotoWork>& work() const { return work_; }
  vm::Result<void> LoadPoints(const std::string& path);
  vm::Result<void> SavePoints(const std::string& path);
  /// More photos of the person, from the side, which the face that is built is made of as well;
  /// another photo opened takes them away.
  vm::Result<void> AddSidePhoto(const std::string& path);
  void RemoveSidePhotos() { sides_.clear(); }
  const SidePhotos& side_photos() const { return sides_; }
  /// Back to where they were found.
  vm::Result<void> ResetPoints();
  /// Moves the selection from where it is in `from`; see Drag.
  void DragSelection(const PointMap& from, glm::vec2 by, std::string_view merge);
  std::set<int> selection;
  bool symmetric = true;
  float reach01 = 0.2F;  ///< how far others go along, in distances of the outer eye corners
  /// Says where it lies, and then which photos from the side were left out.
  vm::Result<std::string> BuildFace(const std::string& name, const std::string& folder);

  // Units and expressions. Strengths 0..2.
  vm::Result<void> SetUnit(int unit, bool left, bool right, float strength,
                           std::string_view merge = "");
  void SetLook(const fsm::FaceLook& look, std::string what, std::string_view merge = "");
  vm::Result<void> SetExpression(std::string_view name, int pattern, const fsm::FaceLook& look,
                                 std::string_view merge = "");
  vm::Result<void> SetTiming(std::string_view name, bool posed,
                             const fsm::Expression::Timing& timing, std::string_view merge = "");
  /// A pattern that looks as the last one, or a new expression with an empty pattern 1.
  vm::Result<void> AddPattern(std::string_view name);
  /// The expression too with its last one.
  vm::Result<void> RemovePattern(std::string_view name, int pattern);

  // Mouth shapes, of the 14 or the 28.
  const fsm::Visemes& shapes(bool bilingual) const {
    return bilingual ? state().shapes28 : state().shapes14;
  }
  vm::Result<void> SetShape(bool bilingual, const fsm::Viseme& shape, std::string_view merge = "");

  // Movements of the head.
  using Keys = std::vector<fsm::HeadCurve::Key>;
  vm::Result<void> SetCurve(std::string_view kind, int pattern, const Keys& keys,
                            std::string_view merge = "");
  /// Moves as the last one of its kind.
  vm::Result<void> AddCurve(std::string_view kind);
  vm::Result<void> RemoveCurve(std::string_view kind, int pattern);

  // How far each unit moves which skin. Rows of a unit count from 1; see UnitRowKinds for columns.
  vm::Result<void> SetRow(int unit, int row, std::string_view column, const std::string& value,
                          std::string_view merge = "");
  /// `values`: what follows the unit, "" = an example.
  vm::Result<void> AddRow(int unit, std::string_view word, const std::string& values = "");
  vm::Result<void> RemoveRow(int unit, int row);
  /// What the program carries: while nothing else is edited, it is this very object.
  const std::shared_ptr<const Units>& built_in_units() const { return built_in_units_; }

  // Identity: a built-in face made into somebody else.
  vm::Result<void> SetBase(std::string_view name);
  vm::Result<void> SetSlider(std::string_view name, float value, std::string_view merge = "");
  /// A face of the folder of faces ("" = where fsm looks), which fsm --mask NAME wears. Saving says
  /// where.
  vm::Result<void> LoadIdentity(const std::string& name, const std::string& folder);
  vm::Result<std::string> SaveIdentity(const std::string& name, const std::string& folder);

  // Files of tables.
  vm::Result<void> Load(Part part, const std::string& path, bool bilingual = false);
  vm::Result<void> Save(Part part, const std::string& path, bool bilingual = false);
  vm::Result<void> LoadTables(const std::string& folder);
  /// Writes the tables that differ from what the program carries or stand in the folder; says how
  /// many.
  vm::Result<int> SaveTables(const std::string& folder);

 private:
  explicit Editor(fsm::MotionTables tables);
  void MarkSaved(Part part);
  std::vector<fsm::FaceLook>* PatternsOf(State& state, std::string_view name) const;
  vm::Result<void> CheckPattern(std::string_view name, int pattern) const;
  vm::Result<void> CheckCurve(std::string_view kind, int pattern) const;
  vm::Result<std::size_t> RowOf(int unit, int row) const;
  vm::Result<void> ChangeRows(UnitRows rows, const std::string& what, std::string_view merge);
  vm::Result<std::shared_ptr<const Units>> UnitsIn(const std::string& folder) const;

  fsm::MotionTables tables_;  // as read; what is edited lies in the state
  std::shared_ptr<const Units> built_in_units_;
  std::string identity_other_;  // lines of its file that are not edited
  std::string expressions_text_, shapes14_text_, shapes28_text_, motions_text_;
  History history_;
  std::array<std::uint64_t, kParts> saved_{};
  std::shared_ptr<FaceModels> models_;
  std::shared_ptr<const PhotoWork> work_;
  SidePhotos sides_;
};

/// The key frames are in order of time from above 0, angles within 180 degrees. Error: kBadValue.
vm::Result<void> CheckKeys(const Editor::Keys& keys);
/// Error: kBadValue.
vm::Result<void> CheckUnit(int unit);

}  // namespace editor
