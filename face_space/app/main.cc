// face_space: units out of recordings of a face (Eigen-AUs), and a space of emotions.

#include <iostream>

#include "face_space/app/commands.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Units of fsm out of recordings of a face, and a space in which a point is an expression\n"
      "(docs/face_space.md)");
  app.set_version_flag("--version", "face_space (Galatea) " GALATEA_VERSION);
  app.require_subcommand(1);
  facespace::Command chosen;
  for (const auto add : {facespace::AddUnits, facespace::AddEmotions, facespace::AddWhere,
                         facespace::AddOnsets, facespace::AddPerform}) {
    const facespace::Command command = add(app);
    CLI::App* const sub = app.get_subcommands({}).back();
    sub->final_callback([&chosen, command] { chosen = command; });
  }
  CLI11_PARSE(app, argc, argv);
  try {
    chosen();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "face_space: " << error.what() << std::endl;
    return 1;
  }
}
