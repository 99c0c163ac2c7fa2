// galatea-log: prints, measures and draws session logs of the hub, plain or compressed.

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>

#include "agent_manager/log/log_writer.h"
#include "agent_manager/log_tool/entries.h"

int main(int argc, char** argv) {
  CLI::App app(
      "Looks into session logs: prints the lines selected, or how long answers took (--delays), or "
      "draws a timeline (--timeline)",
      "galatea-log");
  std::vector<std::string> files;
  am::Selection selection;
  bool delays = false;
  std::string timeline;
  double since = 0, until = 0;
  app.add_option("FILE", files, "Session logs, oldest first; .gz too")->required();
  app.add_option("--from", selection.from, "Senders (* stands for any text)");
  app.add_option("--to", selection.to, "Receivers");
  app.add_option("--slot", selection.slot, "Slots, such as 'Speak*'");
  app.add_option("--command", selection.command, "set inq prop save rest del def do rep tell");
  app.add_option("--text", selection.text, "Text somewhere in the line");
  auto* since_option = app.add_option("--since", since, "From this time on, ms");
  auto* until_option = app.add_option("--until", until, "Up to this time, ms");
  app.add_flag("--delays", delays, "How long tagged requests took, by receiver and slot");
  app.add_option("--timeline", timeline, "Write a picture (SVG) to this file");
  app.set_version_flag("--version", "galatea-log (Galatea) " GALATEA_VERSION);
  CLI11_PARSE(app, argc, argv);
  try {
    const auto time = [](double ms) { return vm::Time(static_cast<vm::Time::rep>(ms * 1000)); };
    if (*since_option) selection.since = time(since);
    if (*until_option) selection.until = time(until);
    std::size_t bad = 0;
    std::vector<am::Entry> entries;
    for (const std::string& file : files) {
      for (am::Entry& entry : am::ParseLog(am::ReadLog(file), bad)) {
        if (am::Selects(selection, entry)) entries.push_back(std::move(entry));
      }
    }
    const auto exchanges = am::FindExchanges(entries);
    if (delays) std::cout << am::DelayTable(exchanges);
    if (!timeline.empty()) {
      std::ofstream file(timeline, std::ios::binary);
      if (!file || !(file << am::TimelineSvg(entries, exchanges)) || !file.flush())
        throw std::runtime_error("cannot write '" + timeline + "'");
    }
    if (!delays && timeline.empty()) {
      for (const am::Entry& entry : entries) std::cout << am::FormatLogEntry(entry.log) << '\n';
    }
    if (bad > 0) std::cerr << "galatea-log: " << bad << " lines were none of a session log\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "galatea-log: " << error.what() << std::endl;
    return 1;
  }
}
