// What the files of the commands share.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace brickfield {

/// What the chosen command does once the whole command line is parsed; returns the exit code.
using CommandAction = std::function<int()>;

} // namespace brickfield
