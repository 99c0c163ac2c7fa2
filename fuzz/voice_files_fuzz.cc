// Files the voice and the ear read: sounds with headers that lie, voice files, prosody files, notes
// beside a sound, traces of open_jtalk. Each from a file in memory.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "sound/sound_file.h"
#include "ssm/engines/open_jtalk_program.h"
#include "ssm/engines/voice_file.h"
#include "ssm/engines/wav_piece.h"
#include "ssm/voice/prosody.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const int file = memfd_create("fuzz", 0);
  if (file < 0 || write(file, data, size) != static_cast<ssize_t>(size)) __builtin_trap();
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  static_cast<void>(sound::ReadSound(path));
  static_cast<void>(ssm::ReadSoundFile(path));
  static_cast<void>(ssm::ReadVoiceFileHead(path));
  static_cast<void>(ssm::ReadProsody(path));
  close(file);
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto trace = ssm::ParseOpenJtalkTrace(text)) {
    const auto phonemes = ssm::PhonemesOf(*trace, trace->ends);
    static_cast<void>(ssm::WordsOf(*trace, phonemes));
  }
  return 0;
}
