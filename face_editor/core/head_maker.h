#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "fsm/rig/head.h"
#include "vm_protocol/core/result.h"

namespace editor {

struct BuiltFace;

/// A head ready to be shown, and what is known of it if it was made from a photo.
struct MadeHead {
  std::shared_ptr<const fsm::Head> head;
  std::shared_ptr<const BuiltFace> built;
  std::string notice;  ///< what the user should know; may be empty
  /// Makes it anew with other units, where it is not Head::WithUnits that does so; takes seconds.
  std::function<std::shared_ptr<const fsm::Head>(const fsm::UnitTable&)> remake = nullptr;
};

/// Makes heads aside, so that dragging never waits. Owns one thread, joined in the destructor; of
/// jobs asked for while it works only the last is done. Jobs must not throw. Thread: any.
class HeadMaker {
 public:
  using Job = std::function<vm::Result<MadeHead>()>;

  HeadMaker();
  ~HeadMaker();
  HeadMaker(const HeadMaker&) = delete;
  HeadMaker& operator=(const HeadMaker&) = delete;

  void Ask(Job job);
  /// The result of the last job that ended, once.
  std::optional<vm::Result<MadeHead>> Take();
  /// True while something is to be done or to be taken.
  bool busy() const;

 private:
  void Work();

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_.
  Job next_;
  bool working_ = false, ended_ = false;
  std::optional<vm::Result<MadeHead>> made_;

  std::thread thread_;
};

}  // namespace editor
