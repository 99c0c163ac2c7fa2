#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fsm/app/wardrobe.h"
#include "fsm/base/table_folder.h"
#include "fsm/faces/original_faces.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Faces that are heads of ours: those given, the built-in ones and those of the folder of faces.
class HeadWardrobe final : public Wardrobe {
 public:
  /// `more`: faces beside the others, listed before them. `tables`: of MakeHeadOfName.
  HeadWardrobe(std::vector<NamedFace> more, TableFolder tables)
      : more_(std::move(more)), tables_(std::move(tables)) {}

  std::vector<std::string> Faces() const override;
  vm::Result<void> Wear(const std::string& face) override;
  vm::Result<MouthMeasure> Measure(const FaceState& state) override;
  /// The head worn, made by the first call; valid until the next Wear. May be called on another
  /// thread while nothing else uses this. Throws std::runtime_error with a sentence if it cannot be
  /// made.
  const Head& head();

 private:
  std::unique_ptr<Head> Make(const std::string& face) const;

  const std::vector<NamedFace> more_;
  const TableFolder tables_;
  std::string worn_;            // "" = the first
  std::unique_ptr<Head> head_;  // made at the first need, as drawing may never be asked for
};

}  // namespace fsm
