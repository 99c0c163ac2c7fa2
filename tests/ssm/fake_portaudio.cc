#include "tests/ssm/fake_portaudio.h"

#include <portaudio.h>

#include <utility>

namespace fake_portaudio {
namespace {

struct World {
  std::vector<Device> devices;
  std::vector<PaDeviceInfo> infos;
  int default_device = paNoDevice;
  bool refuse = false;
  std::size_t swallow = 0;
  PaStreamCallback* callback = nullptr;
  void* user = nullptr;
  int opened = paNoDevice;
  bool aborted = false;
};
World world;

}  // namespace

void SetDevices(std::vector<Device> devices, int default_device) {
  world = World{};
  world.devices = std::move(devices);
  for (const Device& device : world.devices) {
    PaDeviceInfo info{};
    info.name = device.name.c_str();
    info.maxOutputChannels = device.output_channels;
    info.defaultLowOutputLatency = 0.02;
    world.infos.push_back(info);
  }
  world.default_device = default_device;
}
void RefuseToOpen(bool refuse) { world.refuse = refuse; }
void SwallowAtStart(std::size_t frames) { world.swallow = frames; }

std::vector<std::int16_t> Take(std::size_t frames, double delay_s) {
  std::vector<std::int16_t> buffer(frames, 0x7777);
  if (world.callback == nullptr || world.aborted) return buffer;
  PaStreamCallbackTimeInfo time{};
  time.currentTime = 100;
  time.outputBufferDacTime = 100 + delay_s;
  world.aborted = world.callback(nullptr, buffer.data(), frames, &time, 0, world.user) == paAbort;
  return buffer;
}
bool StreamIsOpen() { return world.callback != nullptr; }
std::string OpenedDevice() {
  return world.opened < 0 ? "" : world.devices[static_cast<std::size_t>(world.opened)].name;
}

}  // namespace fake_portaudio

using fake_portaudio::world;

extern "C" {
PaError Pa_Initialize() { return paNoError; }
PaError Pa_Terminate() { return paNoError; }
PaDeviceIndex Pa_GetDeviceCount() { return static_cast<PaDeviceIndex>(world.devices.size()); }
PaDeviceIndex Pa_GetDefaultOutputDevice() { return world.default_device; }
const PaDeviceInfo* Pa_GetDeviceInfo(PaDeviceIndex device) {
  return &world.infos[static_cast<std::size_t>(device)];
}
const char* Pa_GetErrorText(PaError) { return "refused"; }
PaError Pa_OpenStream(PaStream** stream, const PaStreamParameters*,
                      const PaStreamParameters* output, double, unsigned long, PaStreamFlags,
                      PaStreamCallback* callback, void* user) {
  if (world.refuse) return paDeviceUnavailable;
  world.callback = callback;
  world.user = user;
  world.opened = output->device;
  *stream = &world;
  return paNoError;
}
PaError Pa_StartStream(PaStream*) {
  for (std::size_t left = world.swallow; left >= 512; left -= 512) fake_portaudio::Take(512, 0);
  return paNoError;
}
PaError Pa_AbortStream(PaStream*) { return paNoError; }
PaError Pa_CloseStream(PaStream*) {
  world.callback = nullptr;
  return paNoError;
}
}
