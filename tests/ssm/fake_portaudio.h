#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// A PortAudio in memory, linked in place of the library: the test is the device and asks for
/// sound when it likes.
namespace fake_portaudio {

struct Device {
  std::string name;
  int output_channels = 1;
};

/// What the library has; set before the sink is opened.
void SetDevices(std::vector<Device> devices, int default_device);
/// The stream cannot be opened.
void RefuseToOpen(bool refuse);
/// While the stream starts, takes this many frames at once, as a device without a clock does.
void SwallowAtStart(std::size_t frames);

/// Asks for a buffer whose first frame will be heard `delay_s` from now; what the sink gave.
std::vector<std::int16_t> Take(std::size_t frames, double delay_s);
bool StreamIsOpen();
std::string OpenedDevice();

}  // namespace fake_portaudio
