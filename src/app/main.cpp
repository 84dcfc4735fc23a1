// The brickfield program; all it does stands in command_line.h.
#include "app/command_line.h"
#include "app/session.h"

int main(int argumentCount, char** arguments) {
  brickfield::catchInterrupts();
  return brickfield::runCommandLine(std::vector<std::string>(arguments + 1, arguments + argumentCount));
}
