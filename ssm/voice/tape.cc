#include "ssm/voice/tape.h"

#include <algorithm>

#include "vm_protocol/core/file_kind.h"

namespace ssm {

vm::Result<std::unique_ptr<Tape>> Tape::Start(const std::string& path, vm::Time now) {
  if (auto fit = vm::CheckWritable(path); !fit) return std::unexpected(fit.error());
  auto file = WavWriter::Open(path);
  if (!file) return std::unexpected(file.error());
  return std::unique_ptr<Tape>(new Tape(std::move(*file), now));
}

vm::Result<void> Tape::Told(vm::Result<void> written) const {
  if (!written)
    written.error().text +=
        "; the recording ends after " + std::to_string(ToMs(file_->frames()).count()) + " ms";
  return written;
}

vm::Result<void> Tape::SilenceUntil(std::size_t frame) {
  frame = std::min(frame, FramesIn(kMaxLength));
  if (frame <= file_->frames()) return {};
  return Told(file_->WriteSilence(frame - file_->frames()));
}

vm::Result<void> Tape::Add(vm::Time at, std::span<const std::int16_t> heard) {
  const vm::Time offset = at - start_;
  if (offset >= kMaxLength) return {};
  if (auto silent = SilenceUntil(FramesIn(offset)); !silent) return silent;
  // The frame of the tape at which `heard` begins may lie before the point reached.
  const std::size_t begin = FramesIn(offset);
  const std::size_t before = FramesIn(-offset);
  const std::size_t skip = std::min(before + file_->frames() - begin, heard.size());
  return Told(file_->Write(heard.subspan(skip)));
}

vm::Result<void> Tape::Close(vm::Time now) {
  auto silent = SilenceUntil(FramesIn(now - start_));
  file_.reset();
  return silent;
}

}  // namespace ssm
