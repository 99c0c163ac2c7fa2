#pragma once

#include <functional>
#include <memory>
#include <string>

#include "fsm/film/film_writer.h"
#include "fsm/image/image_file.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Access to pictures and films on disk. Tests replace it by one to memory.
struct MediaFiles {
  std::function<vm::Result<void>(const Image&, const std::string& path)> write_image = WriteImage;
  std::function<vm::Result<Image>(const std::string& path)> read_image = ReadImage;
  std::function<vm::Result<std::unique_ptr<FilmWriter>>(const std::string& path, int width,
                                                        int height, double per_second,
                                                        const std::string& comment)>
      open_film = FilmWriter::Open;
};

}  // namespace fsm
