#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fsm/app/face_library.h"
#include "fsm/base/table_folder.h"
#include "fsm/faces/original_faces.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Heads: those given, the built-in ones and those in FacesFolder.
class HeadLibrary final : public FaceLibrary {
 public:
  /// `more`: additional faces, listed first. `tables`: for MakeHeadOfName.
  HeadLibrary(std::vector<NamedFace> more, TableFolder tables)
      : more_(std::move(more)), tables_(std::move(tables)) {}

  std::vector<std::string> Faces() const override;
  vm::Result<void> Select(const std::string& face) override;
  vm::Result<MouthMeasure> Measure(const FaceState& state) override;
  /// Returns the current head, made by the first call; valid until the next Select. May be called
  /// on another thread while nothing else uses this. Throws std::runtime_error if it cannot be
  /// made.
  const Head& head();

 private:
  std::unique_ptr<Head> Make(const std::string& face) const;

  const std::vector<NamedFace> more_;
  const TableFolder tables_;
  std::string current_;         // "" = the first
  std::unique_ptr<Head> head_;  // made by head(), since it may never be drawn
};

}  // namespace fsm
