#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "face_editor/core/editor.h"
#include "face_editor/core/head_maker.h"
#include "fsm/render/renderer.h"

namespace editor {

/// The live preview: which head is worn, made anew whenever what it is made of is edited, and
/// drawn.
class Stage {
 public:
  /// `given`: worn while no photo is open; may have no head.
  Stage(fsm::RenderContext& context, MadeHead given);

  /// Which head is shown: of the photo and a head from elsewhere the one opened last, the photo's
  /// if there is one, or the built-in face with its sliders.
  enum class Wanted { kLast, kPhoto, kIdentity };
  /// Asks for heads that are needed and takes those that are made. Errors: those of the points and
  /// of Open, once each.
  vm::Result<void> Update(const Editor& editor, Wanted wanted);
  /// Makes a head from elsewhere that is then shown; what was shown before stays until it is made.
  void Open(HeadMaker::Job job) { opener_.Ask(std::move(job)); }
  bool busy() const { return maker_.busy() || opener_.busy() || remaker_.busy(); }
  /// What is to be known of a head that was opened; "" once it is taken.
  std::string notice;
  /// The head as its units move it now; nullptr while the first one is being made.
  const fsm::Head* head() const { return moved_ ? moved_.get() : head_.get(); }
  /// The last face made from the photo that is open; nullptr if there is none.
  const std::shared_ptr<const BuiltFace>& built() const { return built_; }

  /// Where `units` alone move skin that faces the front, as it lies in `state`, and by how many
  /// millimetres in `full`.
  struct Touched {
    glm::vec3 at;
    float by;
  };
  std::vector<Touched> TouchedBy(const fsm::UnitTable& units, const fsm::FaceState& full,
                                 const fsm::FaceState& state) const;

  void Draw(const fsm::Viewport& pane, const fsm::FaceState& state);
  fsm::Scene scene;
  std::array<float, 2> turn{};  ///< of the whole figure, degrees: down, to the viewer's right

 private:
  vm::Result<void> Take(const Editor& editor, Wanted wanted);
  vm::Result<void> TakeOpened();
  void TakeUnits(const Editor& editor);

  std::unique_ptr<fsm::Renderer> renderer_;
  MadeHead given_;
  std::shared_ptr<const fsm::Head> head_;
  // head_ by the units that are edited, made anew with either; nullptr: as it is.
  std::shared_ptr<const fsm::Head> moved_, moved_of_;
  std::shared_ptr<const Units> moved_by_;
  std::shared_ptr<const BuiltFace> built_;
  enum class Source { kNone, kGiven, kPhoto, kIdentity } source_ = Source::kNone;
  std::shared_ptr<const PhotoWork> work_;
  std::shared_ptr<const PhotoWork> last_work_;  // the photo opened last
  bool given_last_ = false;                     // given_ was opened after it
  std::uint64_t version_ = 0;                   // of what the head worn or asked for is made of
  fsm::HeadVertices vertices_;
  HeadMaker maker_, opener_, remaker_;
};

/// The lines of the fitted mesh over the photo, in its pixels: what faces the viewer.
std::vector<std::pair<glm::vec2, glm::vec2>> MeshLines(const facefit::FittedHead& fitted);

}  // namespace editor
