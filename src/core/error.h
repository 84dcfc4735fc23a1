// The project's exceptions. Three classes of fault: bad input (exit code 2), our failure (exit code 1), and expected
// absence, which is no exception but a std::optional.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace brickfield {

/// Base of all exceptions that Brickfield throws; what() is one line that a user can act on.
class Error : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The caller gave something that cannot be used: a file, an argument, a driver that lacks a feature. Exit code 2.
class BadInput : public Error {
public:
  using Error::Error;
  /// subject file or argument at fault; element part of it, may be empty ("node 3 \"Arm\""); reason what is wrong.
  BadInput(std::string_view subject, std::string_view element, std::string_view reason);
};

/// Something failed that is not the caller's fault: a broken invariant, a shader that does not compile. Exit code 1.
class Failure : public Error {
public:
  using Error::Error;
};

/// The user asked to stop (Ctrl-C). Nothing half-written is left.
class Cancelled : public Error {
public:
  Cancelled() : Error("cancelled") {}
};

} // namespace brickfield
