// Speech by espeak-ng for another program, over stdin and stdout. It is a program of its own since
// espeak-ng's licence (GPL-3+) would else be that of everything linked with it; see README.md here.
//
//   say VOICE WPM PITCH BYTES        then BYTES bytes of UTF-8 text
//   sound RATE FRAMES LINES          then LINES lines, then FRAMES 16 bit samples of this machine
//     p MS NAME                        a phoneme begins (IPA; - is a pause)
//     w MS CHARACTER COUNT             a word begins; its place in the text, from 0
//   error TEXT                       instead of sound
//
// VOICE is a voice of espeak-ng ("de", "ja+f2"), WPM 80 to 450, PITCH 0 to 99. Ends at end of
// input. Each text is spoken by a child of its own: the library's sound depends on what it said
// before, by some ms, and the same text shall sound the same.

#include <espeak-ng/speak_lib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr std::size_t kMaxTextBytes = 1u << 20;
constexpr std::size_t kMaxFrames = 3600u * 22050u;

struct Sound {
  std::vector<short> samples;
  std::string lines;
  std::size_t count = 0;

  void Add(const std::string& line) {
    lines += line + "\n";
    ++count;
  }
};

Sound* g_sound = nullptr;  // the library's callback gets no pointer that lives as long

int OnSound(short* samples, int count, espeak_EVENT* events) {
  if (samples != nullptr) {
    g_sound->samples.insert(g_sound->samples.end(), samples, samples + count);
  }
  for (; events->type != espeakEVENT_LIST_TERMINATED; ++events) {
    const std::string at = std::to_string(events->audio_position);
    if (events->type == espeakEVENT_PHONEME) {
      // Eight bytes, not always ended by a zero.
      std::string name(events->id.string, strnlen(events->id.string, sizeof events->id.string));
      if (name.empty()) name = "-";
      g_sound->Add("p " + at + " " + name);
    } else if (events->type == espeakEVENT_WORD && events->length > 0) {
      g_sound->Add("w " + at + " " + std::to_string(events->text_position - 1) + " " +
                   std::to_string(events->length));
    }
  }
  return g_sound->samples.size() > kMaxFrames ? 1 : 0;
}

/// By name, else by language: some languages ("en-gb") are the name of no voice.
bool ChooseVoice(const std::string& voice) {
  if (espeak_SetVoiceByName(voice.c_str()) == EE_OK) return true;
  espeak_VOICE wanted{};
  wanted.languages = voice.c_str();
  if (espeak_SetVoiceByProperties(&wanted) != EE_OK) return false;
  // Where nothing fits, the library takes any voice and says it went well.
  const espeak_VOICE* chosen = espeak_GetCurrentVoice();
  return chosen != nullptr && chosen->languages != nullptr &&
         voice.compare(0, 2, chosen->languages + 1, 2) == 0;
}

std::string Say(const std::string& voice, int wpm, int pitch, const std::string& text,
                Sound& sound) {
  if (!ChooseVoice(voice)) return "there is no voice '" + voice + "'";
  espeak_SetParameter(espeakRATE, wpm, 0);
  espeak_SetParameter(espeakPITCH, pitch, 0);
  g_sound = &sound;
  const auto said =
      espeak_Synth(text.c_str(), text.size() + 1, 0, POS_CHARACTER, 0,
                   espeakCHARS_UTF8 | espeakENDPAUSE | espeakPHONEMES, nullptr, nullptr);
  return said == EE_OK ? "" : "espeak-ng could not speak the text";
}

/// Synthesises the text and answers.
void Speak(int rate, const std::string& voice, int wpm, int pitch, const std::string& text) {
  Sound sound;
  const std::string error = Say(voice, wpm, pitch, text, sound);
  if (!error.empty()) {
    std::cout << "error " << error << std::endl;
    return;
  }
  std::cout << "sound " << rate << " " << sound.samples.size() << " " << sound.count << "\n"
            << sound.lines;
  std::cout.write(reinterpret_cast<const char*>(sound.samples.data()),
                  static_cast<std::streamsize>(sound.samples.size() * sizeof(short)));
  std::cout.flush();
}

/// One request; false at the end of input.
bool Answer(int rate) {
  std::string line;
  if (!std::getline(std::cin, line)) return false;
  std::istringstream words(line);
  std::string verb, voice;
  int wpm = 0, pitch = 0;
  std::size_t bytes = 0;
  if (!(words >> verb >> voice >> wpm >> pitch >> bytes) || verb != "say" ||
      bytes > kMaxTextBytes) {
    std::cout << "error expected say VOICE WPM PITCH BYTES" << std::endl;
    return true;
  }
  std::string text(bytes, '\0');
  if (!std::cin.read(text.data(), static_cast<std::streamsize>(bytes))) return false;
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    Speak(rate, voice, wpm, pitch, text);
    _exit(0);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || status != 0) {
    std::cout << "error espeak-ng ended in the middle of the text" << std::endl;
  }
  return true;
}

}  // namespace

int main() {
  std::ios::sync_with_stdio(false);
  const int rate = espeak_Initialize(
      AUDIO_OUTPUT_SYNCHRONOUS, 1000, nullptr,
      espeakINITIALIZE_PHONEME_EVENTS | espeakINITIALIZE_PHONEME_IPA | espeakINITIALIZE_DONT_EXIT);
  if (rate <= 0) {
    std::cout << "error espeak-ng cannot be started" << std::endl;
    return 1;
  }
  espeak_SetSynthCallback(OnSound);
  while (Answer(rate)) {
  }
  return 0;
}
