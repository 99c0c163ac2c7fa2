#pragma once

#include <functional>
#include <memory>
#include <string>

#include "ssm/voice/audio_sink.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace ssm {

/// A loudspeaker through PortAudio. The stream is opened at once and runs, silent between
/// utterances, for as long as the sink lives, so that an utterance begins at its instant to the
/// sample, counted at the loudspeaker (the device's own delay is known and allowed for).
/// `device` is a part of a device's name, any case; empty = the default one.
/// Thread: the library's own thread reads the samples; everything shared with it is atomic.
/// Errors: kUnavailable with one sentence: no device, no such device (naming those there are), it
/// cannot be opened, or it is one that swallows sound without taking its time (ALSA's "null").
/// `instants`: a steady clock that any thread may read, empty for the real one.
/// REQUIRES: the scheduler's clock runs as `instants` does.
vm::Result<std::unique_ptr<AudioSink>> OpenPortAudio(vm::Scheduler& scheduler,
                                                     const std::string& device,
                                                     std::function<vm::Time()> instants = {});
/// True if there is a default device that might be opened.
bool HasSoundDevice();

}  // namespace ssm
