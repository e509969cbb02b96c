"""Writes the source by which the extension finds HDF5: the system's library, loaded when the first file of it is opened.

It brings libraries for networks and encryption that take half as long to load as numpy, and would be a third of the
extension if it were linked in.

usage: outside_hdf5.py ARCHIVE LIBRARY PACKAGE PROCESSOR FILE. ARCHIVE has the code that calls it, PACKAGE the library in Debian.
"""
import re
import subprocess
import sys

OWN = ("H5open", "H5dont_atexit")  # written out below
SOURCE = r"""// Made by core/python/outside_hdf5.py.
#include <cstdint>
#include <string>

#include <dlfcn.h>

#include "base/error.h"

namespace {{

constexpr const char* library_name = "{library}";
constexpr const char* names[] = {{{names}}};
constexpr int count = sizeof names / sizeof *names;

}}  // namespace

extern "C" {{
/// Where each function is, once open_library() was here: whoever calls one holds Hdf5Lock, which asks for it.
[[gnu::visibility("hidden")]] void* freeplay_hdf5_places[count];

// Data of the library, by the names that it has there: copies, which do not change once it is open.
{data}}}

// What the rooms call jumps to the library.
asm(R"(.text
{jumps})");

namespace {{

struct DataPlace {{
  const char* name;
  std::int64_t* here;
}};
constexpr DataPlace data[] = {{{data_places}}};

void* symbol(void* library, const char* name) {{
  if (void* const place = ::dlsym(library, name)) return place;
  throw freeplay::Error(freeplay::Error::Category::file, "no-library", std::string("the library ") + library_name + " lacks " + name);
}}

using Open = int (*)();

Open open_library() {{
  void* const library = ::dlopen(library_name, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {{
    throw freeplay::Error(freeplay::Error::Category::file, "no-library", std::string("HDF5 cannot be loaded: ") + ::dlerror(), {{}},
                          "Debian has it as {package}");
  }}
  for (int i = 0; i < count; ++i) freeplay_hdf5_places[i] = symbol(library, names[i]);
  const Open open = reinterpret_cast<Open>(symbol(library, "H5open"));
  if (open() < 0) throw freeplay::Error(freeplay::Error::Category::file, "no-library", "HDF5 cannot be set up");
  for (const DataPlace& place : data) *place.here = *static_cast<const std::int64_t*>(symbol(library, place.name));
  return open;
}}

}}  // namespace

extern "C" {{
[[gnu::visibility("hidden")]] int freeplay_open_hdf5() asm("H5open");
int freeplay_open_hdf5() {{
  static const Open open = open_library();
  return open();
}}

/// How HDF5 ends is a setting of the whole process, in which others may use it.
[[gnu::visibility("hidden")]] int freeplay_hdf5_end() asm("H5dont_atexit");
int freeplay_hdf5_end() {{ return 0; }}

// MAT-files are for commands: the package makes and reads none.
{mat}}}
"""
MAT = """[[gnu::visibility("hidden")]] void* freeplay_{name}() asm("{name}");
void* freeplay_{name}() {{ return nullptr; }}
"""
JUMPS = {"x86_64": ".globl {name}\n.hidden {name}\n.type {name}, @function\n{name}: jmp *freeplay_hdf5_places+{offset}(%rip)\n",
         "aarch64": ".globl {name}\n.hidden {name}\n.type {name}, %function\n{name}: adrp x16, freeplay_hdf5_places+{offset}\n"
                    "ldr x16, [x16, :lo12:freeplay_hdf5_places+{offset}]\nbr x16\n"}


def asked(archive):
    """Names that the code of an archive takes from elsewhere."""
    text = subprocess.run(["nm", "-u", archive], check=True, capture_output=True, text=True).stdout
    return sorted(set(re.findall(r"^ +U (\w+)$", text, re.M)))


def source(archive, library, package, processor):
    names = asked(archive)
    hdf5 = [name for name in names if name.startswith("H5") and name not in OWN]
    data = [name for name in hdf5 if name.endswith("_g")]
    functions = [name for name in hdf5 if name not in data]
    return SOURCE.format(
        library=library, package=package, names=", ".join('"%s"' % name for name in functions),
        data="".join('[[gnu::visibility("hidden")]] std::int64_t %s = -1;\n' % name for name in data),
        data_places=", ".join('{"%s", &%s}' % (name, name) for name in data),
        jumps="".join(JUMPS[processor].format(name=name, offset=8 * i) for i, name in enumerate(functions)),
        mat="".join(MAT.format(name=name) for name in names if name.startswith("Mat_")))


if __name__ == "__main__":
    with open(sys.argv[5], "w", encoding="utf-8") as file:
        file.write(source(*sys.argv[1:5]))
