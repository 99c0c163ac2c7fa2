#include "ssm/sinks/portaudio_library.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <string_view>
#include <utility>

#include "vm_protocol/core/lower_case.h"

namespace ssm {
namespace {

bool CanInitialize() {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    _exit(Pa_Initialize() == paNoError ? 0 : 1);
  }
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

bool SwallowsSound(std::string_view name) {
  const std::string lower = vm::LowerCase(name);
  return lower == "null" || lower.find("discard all samples") != std::string::npos;
}

}  // namespace

QuietStderr::QuietStderr() {
  std::fflush(stderr);
  saved_ = dup(STDERR_FILENO);
  const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (null >= 0) {
    dup2(null, STDERR_FILENO);
    close(null);
  }
}

QuietStderr::~QuietStderr() {
  std::fflush(stderr);
  if (saved_ < 0) return;
  dup2(saved_, STDERR_FILENO);
  close(saved_);
}

PortAudioLibrary::PortAudioLibrary()
    : error_(CanInitialize() ? Pa_Initialize() : paNotInitialized) {}

PortAudioLibrary::~PortAudioLibrary() {
  if (error_ == paNoError) Pa_Terminate();
}

vm::Result<PaDeviceIndex> ChooseOutputDevice(const std::string& wanted) {
  std::string names;
  PaDeviceIndex chosen = wanted.empty() ? Pa_GetDefaultOutputDevice() : paNoDevice;
  for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i) {
    const PaDeviceInfo* info = Pa_GetDeviceInfo(i);
    if (info->maxOutputChannels < 1) continue;
    names += (names.empty() ? "" : ", ") + std::string(info->name);
    const bool fits = vm::LowerCase(info->name).find(vm::LowerCase(wanted)) != std::string::npos;
    if (chosen == paNoDevice && !wanted.empty() && fits) chosen = i;
  }
  if (chosen == paNoDevice) {
    return vm::Fail(vm::Errc::kUnavailable,
                    names.empty() ? "there is no sound device"
                                  : "no sound device '" + wanted + "', expected one of: " + names);
  }
  if (SwallowsSound(Pa_GetDeviceInfo(chosen)->name)) {
    return vm::Fail(vm::Errc::kUnavailable, "sound device '" +
                                                std::string(Pa_GetDeviceInfo(chosen)->name) +
                                                "' throws sound away at any speed");
  }
  return chosen;
}

}  // namespace ssm
