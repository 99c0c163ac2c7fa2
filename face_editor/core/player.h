#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "face_editor/core/editor.h"
#include "fsm/motion/face_motion.h"
#include "fsm/rig/face_state.h"
#include "vm_protocol/core/phonemes.h"

namespace editor {

/// What is played on the face to see how it moves; parts left empty are not played.
struct Show {
  std::string expression;
  int pattern = 1;
  bool elicited = false;
  vm::PhonemeList speech;
  std::string motion;
  int motion_pattern = 1;
  bool empty() const { return expression.empty() && speech.empty() && motion.empty(); }
};

/// Plays what is edited, as it is edited: the tables may change while it plays. Pure in time, which
/// is given. The editor outlives it.
class Player {
 public:
  explicit Player(const Editor& editor) : editor_(editor) {}

  /// Errors: kBadValue if the tables have no such thing. `loop`: again and again.
  vm::Result<void> Start(const Show& show, bool loop, vm::Time now);
  void Stop() { motion_.reset(); }
  bool playing(vm::Time now) const;
  const Show& show() const { return show_; }
  /// The face now; nothing if nothing is played any more.
  std::optional<fsm::FaceState> At(vm::Time now);
  /// The phoneme sounding now, "" if none.
  std::string PhonemeAt(vm::Time now);

 private:
  using Command = std::function<vm::Result<void>(fsm::FaceMotion&)>;
  struct Cue {
    vm::Time at;
    Command command;
  };
  vm::Result<void> Plan();
  std::unique_ptr<fsm::FaceMotion> Fresh() const;
  vm::Time Local(vm::Time now) const;

  const Editor& editor_;
  Show show_;
  bool loop_ = false;
  vm::Time start_{0}, length_{0};
  std::vector<Cue> cues_;  // in order of time
  // A motion can only be asked of times after the commands it got.
  std::size_t given_ = 0;
  vm::Time asked_{0};
  std::array<std::uint64_t, kParts> version_{};
  std::unique_ptr<fsm::FaceMotion> motion_;  // its time begins at 0 with each round
};

/// The face with these units and nothing else.
fsm::FaceState StateOf(const fsm::FaceLook& look);

}  // namespace editor
