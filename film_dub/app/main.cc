// Has the person in a film say something else: tracks the face, and paints mouth and chin of its
// own head, speaking the new words, over the old ones.

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

#include "film_dub/app/dub.h"
#include "vm_protocol/core/spawn.h"

int main(int argc, char** argv) {
  filmdub::Dub wanted;
  std::string voices;
  CLI::App app(
      "Has the person in a film say something else (docs/film_dub.md).\n"
      "Only with the consent of whoever is seen: the new film says in its metadata that it was "
      "altered.\n"
      "  film_dub film.mp4 --text \"Good evening.\" --out new.mkv");
  app.set_version_flag("--version", "film_dub (Galatea) " GALATEA_VERSION);
  app.add_option("film", wanted.film, "The film, any that ffmpeg reads, with a face in it")
      ->required();
  auto* const text =
      app.add_option("--text", wanted.speech.text, "What is said instead, spoken by ssm");
  auto* const sound = app.add_option("--sound", wanted.speech.sound,
                                     "A sound file with speech that is heard instead; the mouth "
                                     "follows it");
  text->excludes(sound);
  app.add_option("--voice", wanted.speech.voice, "Of --text: a speaker of ssm (default: its first)")
      ->needs(text);
  app.add_option("--voices", voices, "Of --text: more voices, as ssm --voices");
  app.add_option("-o,--out", wanted.out,
                 "The new film: .mkv keeps every pixel that is not painted over as it was; .mp4, "
                 ".mov and .webm are compressed (default: FILM.dubbed.mkv, in this folder)");
  app.add_option("--field", wanted.tracker.field_degrees,
                 "Degrees the camera sees from below to above (40)")
      ->check(CLI::Range(5.0, 120.0));
  app.add_option("--which", wanted.tracker.which, "Which of several faces: 1 = the largest")
      ->check(CLI::Range(1, 10));
  app.add_option("--networks", wanted.networks,
                 "Where scripts/face_networks.sh put the networks (default: where it does)");
  app.add_flag("--quiet", wanted.quiet, "Nothing on standard error but errors and notices");
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGPIPE, SIG_IGN);
  wanted.speech.voice_module = {vm::ProgramBeside("ssm"), "--sink", "null", "--clock", "virtual"};
  if (!voices.empty()) {
    wanted.speech.voice_module.insert(wanted.speech.voice_module.end(), {"--voices", voices});
  }
  try {
    if (wanted.speech.text.empty() && wanted.speech.sound.empty()) {
      throw std::runtime_error("--text or --sound expected: what is to be said");
    }
    if (!voices.empty() && wanted.speech.text.empty()) {
      throw std::runtime_error("--voices: --text expected, which they speak");
    }
    if (wanted.out.empty()) {
      wanted.out = std::filesystem::path(wanted.film).stem().string() + ".dubbed.mkv";
    }
    filmdub::MakeDub(wanted);
    std::cout << "film_dub: wrote " << wanted.out << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "film_dub: " << error.what() << "\n";
    return 1;
  }
}
