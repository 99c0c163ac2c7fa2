#include "fsm/app/picture_stream.h"

#include <string_view>
#include <utility>

namespace fsm {
namespace {
constexpr const char* kNobody = "NONE";
}

PictureStream::PictureStream(vm::Scheduler& clock, FaceView& view, Draw draw, Moves moves,
                             OnFailure on_failure)
    : clock_(clock),
      view_(view),
      draw_(std::move(draw)),
      moves_(std::move(moves)),
      on_failure_(std::move(on_failure)),
      to_(kNobody) {}

vm::Result<void> PictureStream::SendTo(const std::string& to, int per_second) {
  Disconnect();
  if (to == kNobody) return {};
  constexpr std::string_view kUnix = "unix:";
  if (!to.starts_with(kUnix)) {
    return vm::Fail(vm::Errc::kBadValue, "found '" + to + "', expected NONE or unix:PATH");
  }
  auto sender = PictureSender::Connect(to.substr(kUnix.size()));
  if (!sender) return std::unexpected(std::move(sender.error()));
  sender_ = std::move(*sender);
  to_ = to;
  series_ = {clock_.Now(), static_cast<double>(per_second)};
  next_ = 0;
  touched_ = true;
  timer_.At(series_.start, [this] { Tick(); });
  return {};
}

std::string PictureStream::to() {
  if (sender_ && sender_->gone()) Disconnect();
  return to_;
}

void PictureStream::Disconnect() {
  timer_.Cancel();
  sender_.reset();
  to_ = kNobody;
}

void PictureStream::Tick() {
  if (sender_->gone()) return Disconnect();
  // Skip pictures whose successor is due too.
  const vm::Time now = clock_.Now();
  while (series_.TimeOf(next_ + 1) <= now) ++next_;
  const vm::Time at = series_.TimeOf(next_++);
  const bool wanted = touched_ || at - sent_ >= kStillLimit || moves_(sent_, at);
  if (wanted && !sender_->full() && !DrawAndSend(at)) return;
  timer_.At(series_.TimeOf(next_), [this] { Tick(); });
}

bool PictureStream::DrawAndSend(vm::Time at) {
  if (auto drawn = draw_(at); !drawn) {
    Disconnect();
    on_failure_(drawn.error());
    return false;
  }
  sender_->Send(view_.Read(), at);
  touched_ = false;
  sent_ = at;
  return true;
}

}  // namespace fsm
