// Run when building: writes the build ID of SpiderMonkey and, behind it, what its own functions
// compile to, to the file it is given. See Context::OfThread.
#include <cstdio>
#include <fstream>

#include "task_manager/script/context.h"

namespace {
std::ofstream out;
}

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: write_self_hosted_code FILE\n"), 2;
  out.open(argv[1], std::ios::binary);
  const auto id = vxml::script::LibraryBuildId();
  out.write(id.data(), static_cast<std::streamsize>(id.size()));
  const bool written = vxml::script::WriteSelfHostedCode([](JSContext*, JS::SelfHostedCache code) {
    out.write(reinterpret_cast<const char*>(code.data()),
              static_cast<std::streamsize>(code.size()));
    return out.good();
  });
  out.close();
  if (!written || !out) return std::fprintf(stderr, "%s: cannot be written\n", argv[1]), 1;
}
