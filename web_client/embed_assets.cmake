# Writes a C++ and an assembler source that hold the files of a folder:
#   cmake -D FOLDER=dist -D OUTPUT=asset_table -P embed_assets.cmake
set(content_type_css "text/css; charset=utf-8")
set(content_type_html "text/html; charset=utf-8")
set(content_type_js "text/javascript; charset=utf-8")
set(content_type_svg "image/svg+xml")

set(declarations "")
set(entries "")
set(data ".section .rodata\n")
set(index 0)
file(GLOB names RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT names)
foreach(name ${names})
  get_filename_component(extension ${name} LAST_EXT)
  string(SUBSTRING ${extension} 1 -1 extension)
  if(NOT DEFINED content_type_${extension})
    message(FATAL_ERROR "${name}: no content type is known for this extension")
  endif()
  file(SHA256 ${FOLDER}/${name} hash)
  string(SUBSTRING ${hash} 0 32 hash)
  file(SIZE ${FOLDER}/${name} size)
  string(APPEND declarations "extern \"C\" const unsigned char heliograph_asset_${index}[${size}];\n")
  string(APPEND entries "    {\"${name}\", \"${content_type_${extension}}\", \"\\\"${hash}\\\"\",\n"
    "     heliograph_asset_${index}},\n")
  string(APPEND data ".global heliograph_asset_${index}\nheliograph_asset_${index}:\n"
    ".incbin \"${FOLDER}/${name}\"\n")
  math(EXPR index "${index} + 1")
endforeach()

file(WRITE ${OUTPUT}.S "${data}.section .note.GNU-stack,\"\",%progbits\n")
file(WRITE ${OUTPUT}.cpp "#include \"web_client/asset_table.hpp\"

${declarations}
namespace heliograph::web {

std::span<const Asset> asset_table() {
  static const Asset assets[] = {
${entries}  };
  return assets;
}

}  // namespace heliograph::web
")
