// Labels and error checks that the objects of this room share.
#pragma once

#include <string>
#include <string_view>

#include "gpu/gl.h"

namespace brickfield {

/// Names an object for graphics debuggers and debug messages; labels beyond the driver's limit are cut.
void labelObject(GLenum kind, GLuint id, std::string_view label);

/// error Failure "WHAT: reason" if the GL has an error pending, which may also stem from an earlier call
void requireNoGlError(std::string_view what);

} // namespace brickfield
