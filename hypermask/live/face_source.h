#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "hypermask/live/face_stream.h"
#include "hypermask/live/live_pictures.h"
#include "vm_protocol/core/slot_machine.h"

namespace hypermask {

/// Where the face comes from that is projected: the slots Face (a picture or a film) and Face.from
/// (another module's pictures). Thread: the scheduler's. Lifetime: `slots` outlives it.
class FaceSource {
 public:
  /// `io`: of films and of other modules' pictures; null: there are none.
  /// `changed` is called with each new picture; an empty one means that there is no face.
  FaceSource(vm::SlotMachine& slots, boost::asio::io_context* io,
             std::function<void(const fsm::Image& picture)> changed)
      : slots_(slots), io_(io), changed_(std::move(changed)) {}

  void DeclareSlots();
  /// The newest picture; empty: there is none.
  const fsm::Image& picture() const { return picture_; }
  /// Ends films and streams; no picture comes afterwards.
  void Close();

 private:
  vm::Result<void> Open(const std::string& name);
  vm::Result<void> OpenPicture(const std::string& name);
  vm::Result<void> OpenFilm(const std::string& name);
  vm::Result<void> AskModule(const std::string& module);
  void Take(const fsm::Image& picture);

  vm::SlotMachine& slots_;
  boost::asio::io_context* const io_;
  const std::function<void(const fsm::Image& picture)> changed_;
  std::string from_ = "NONE";
  fsm::Image picture_;
  std::unique_ptr<FaceStream> stream_;
  std::unique_ptr<LivePictures> film_;
};

}  // namespace hypermask
