#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fsm/app/wardrobe.h"
#include "fsm/base/table_folder.h"
#include "fsm/faces/original_faces.h"
#include "fsm/rig/head.h"

namespace fsm {

/// A wardrobe of heads: those given, the built-in ones and those in FacesFolder.
class HeadWardrobe final : public Wardrobe {
 public:
  /// `more`: additional faces, listed first. `tables`: for MakeHeadOfName.
  HeadWardrobe(std::vector<NamedFace> more, TableFolder tables)
      : more_(std::move(more)), tables_(std::move(tables)) {}

  std::vector<std::string> Faces() const override;
  vm::Result<void> Wear(const std::string& face) override;
  vm::Result<MouthMeasure> Measure(const FaceState& state) override;
  /// Returns the current head, made by the first call; valid until the next Wear. May be called on
  /// another thread while nothing else uses this. Throws std::runtime_error if it cannot be made.
  const Head& head();

 private:
  std::unique_ptr<Head> Make(const std::string& face) const;

  const std::vector<NamedFace> more_;
  const TableFolder tables_;
  std::string worn_;            // "" = the first
  std::unique_ptr<Head> head_;  // made by head(), since it may never be drawn
};

}  // namespace fsm
