#pragma once

#include <portaudio.h>

#include <string>

#include "vm_protocol/core/result.h"

/// PortAudio as a value, and its devices. Private to ssm/sinks.
namespace ssm {

/// PortAudio's back ends write dozens of lines to stderr while they look for devices. While this
/// lives, stderr goes nowhere.
class QuietStderr {
 public:
  QuietStderr();
  ~QuietStderr();
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  int saved_ = -1;
};

/// The library, from first to last use. It is tried in a child first: where ALSA has no
/// configuration, PortAudio ends the whole process by an assertion.
class PortAudioLibrary {
 public:
  PortAudioLibrary();
  ~PortAudioLibrary();
  PortAudioLibrary(const PortAudioLibrary&) = delete;
  PortAudioLibrary& operator=(const PortAudioLibrary&) = delete;
  PaError error() const { return error_; }

 private:
  const PaError error_;
};

/// The output device whose name has `wanted` in it (any case; empty = the default one), or why
/// there is none. Error: kUnavailable. REQUIRES: a library without error.
vm::Result<PaDeviceIndex> ChooseOutputDevice(const std::string& wanted);

}  // namespace ssm
