# cmake -DOUTPUT=FILE.cc -DHEADER=room/files.h -DFUNCTION=Files -DFILES="a.lcm|b.lcm|..." -P EmbedFiles.cmake: writes the
# files into C++ source, as what the function of that header returns.
string(REPLACE "|" ";" files "${FILES}")
set(source "#include \"${HEADER}\"\n\nnamespace planbench {\n\n")
string(APPEND source "const std::vector<EmbeddedFile>& ${FUNCTION}() {\n")
string(APPEND source "  static const std::vector<EmbeddedFile> files = {\n")
foreach(file IN LISTS files)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" text)
  string(APPEND source "{\"${name}\", R\"embedded(${text})embedded\"},\n")
endforeach()
string(APPEND source "  };\n  return files;\n}\n\n}  // namespace planbench\n")
file(WRITE "${OUTPUT}" "${source}")
