// A list of work that one dispatch leaves to the next, shaders/lib/work_list.glsl.
#pragma once

#include <string>

#include "gpu/buffer.h"

namespace brickfield {

class Program;

class WorkList {
public:
  explicit WorkList(std::string label);

  /// Empties it, makes room, binds it for the dispatch that fills it.
  void begin(std::size_t mostEntries);
  /// Runs a program in as many groups as the entries take, the list bound. After barriers for commands and storage.
  void dispatch(const Program& program) const;
  std::size_t bytes() const { return buffer_.bytes(); }

private:
  Buffer buffer_;
};

} // namespace brickfield
