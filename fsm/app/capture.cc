#include "fsm/app/capture.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace fsm {

void Capture::Arm(Request request) {
  Cancel();
  request_ = std::move(request);
  armed_ = true;
}

void Capture::Begin(vm::Time at) {
  if (!armed_) return;
  armed_ = false;
  running_ = true;
  series_ = {at, request_.per_second};
  end_.reset();
  next_ = 0;
  written_ = 0;
  bytes_ = 0;
  Tick();
}

void Capture::Tick() {
  if (auto done = DrawNext(); !done) {
    Cancel();
    on_end_(done);
    return;
  }
  WaitOrFinish();
}

vm::Result<void> Capture::DrawNext() {
  if (next_ >= limits_.pictures) {
    return vm::Fail(vm::Errc::kLimit,
                    fmt::format("Capture: more than {} pictures", limits_.pictures));
  }
  if (auto drawn = draw_(next_, series_.TimeOf(next_)); !drawn) return drawn;
  ++next_;
  return queue_.Add();
}

vm::Result<void> Capture::Write(const Image& picture) {
  if (bytes_ >= limits_.bytes) {
    return vm::Fail(vm::Errc::kLimit, fmt::format("Capture: the pictures in '{}' take more than {} "
                                                  "MiB; fewer a second, a smaller view or PNG "
                                                  "take less",
                                                  request_.folder, limits_.bytes >> 20));
  }
  const std::string path =
      fmt::format("{}/{}{:05}{}", request_.folder, request_.prefix, written_ + 1, request_.ending);
  if (auto written = files_.write_image(picture, path); !written) return written;
  std::error_code none;
  if (const auto size = std::filesystem::file_size(path, none); !none) bytes_ += size;
  ++written_;
  return {};
}

void Capture::WaitOrFinish() {
  if (IsOver()) {
    const auto written = queue_.Flush();
    Cancel();
    on_end_(written);
    return;
  }
  timer_.At(series_.TimeOf(next_), [this] { Tick(); });
}

void Capture::End(vm::Time at) {
  if (!running_) return;
  end_ = at;
  WaitOrFinish();
}

void Capture::Cancel() {
  timer_.Cancel();
  static_cast<void>(queue_.Flush());
  armed_ = false;
  running_ = false;
}

}  // namespace fsm
