# The rooms hold, and the script that checks them sees each kind of violation.
set -euo pipefail
tools/check_layers

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder"/src/{core,field,gpu,scene,passes/light,app} "$folder"/bakers
refuses() { # path, line
  mkdir -p "$(dirname "$folder/$1")"
  echo "$2" >"$folder/$1"
  if tools/check_layers "$folder" >/dev/null; then
    echo "check_layers let $1 have: $2"
    exit 1
  fi
  rm "$folder/$1"
}
echo '#include "core/math.h"' >"$folder/src/field/fine.cpp"
tools/check_layers "$folder"
refuses src/core/a.cpp '#include "field/brick_field.h"'
refuses src/field/a.h '#include "gpu/buffer.h"'
refuses src/scene/a.cpp '#include "gpu/buffer.h"'
refuses src/renderer/a.cpp '#include "bakers/bake.h"'
refuses src/passes/light/sun_pass.cpp '#include "passes/light/moon_pass.h"'
refuses src/scene/a.cpp '#include <epoxy/gl.h>'
refuses src/app/a.cpp '#include <embree3/rtcore.h>'
refuses src/field/a.cpp '#  include <OpenImageIO/imageio.h>'
refuses src/app/a.cpp '#include "../core/math.h"'
