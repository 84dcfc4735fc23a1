// OpenGL's functions and constants, for whoever issues GL commands. All other rooms reach epoxy through this header
// only.
#pragma once

#include <epoxy/gl.h>
