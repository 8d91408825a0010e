# Texts built into a program, and the plot library among them.

# spoolwatch_chart_js(variable): the path of Chart.js 3, which Debian packages as libjs-chart.js.
function(spoolwatch_chart_js variable)
  find_file(SPOOLWATCH_CHART_JS chart.min.js
    PATHS /usr/share/javascript/chart.js /usr/local/share/javascript/chart.js
    DOC "Chart.js 3, minified" NO_CMAKE_FIND_ROOT_PATH)
  if(NOT SPOOLWATCH_CHART_JS)
    message(FATAL_ERROR "chart.min.js not found: install libjs-chart.js "
      "(scripts/install-packages build) or name the file with -DSPOOLWATCH_CHART_JS=FILE")
  endif()
  file(READ "${SPOOLWATCH_CHART_JS}" banner LIMIT 200)
  if(NOT banner MATCHES "Chart\\.js v3\\.")
    message(FATAL_ERROR "${SPOOLWATCH_CHART_JS} is not Chart.js 3")
  endif()
  set(${variable} "${SPOOLWATCH_CHART_JS}" PARENT_SCOPE)
endfunction()

# spoolwatch_embed(variable namespace header function file [function file]...): a source file that
# defines, for each pair, `std::string_view function()` with the text of the file.
function(spoolwatch_embed variable namespace header)
  set(assembly "")
  set(functions "")
  set(files "")
  while(ARGN)
    list(POP_FRONT ARGN name file)
    list(APPEND files "${file}")
    string(APPEND assembly "asm(R\"(.section .rodata\n.global embedded_${name}_begin, "
      "embedded_${name}_end\nembedded_${name}_begin:\n.incbin \"${file}\"\n"
      "embedded_${name}_end:\n.byte 0\n.previous)\");\n"
      "extern \"C\" const char embedded_${name}_begin[];\n"
      "extern \"C\" const char embedded_${name}_end[];\n")
    string(APPEND functions "std::string_view ${name}() {\n"
      "  return {embedded_${name}_begin, embedded_${name}_end};\n}\n")
  endwhile()
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${variable}.cpp")
  file(CONFIGURE OUTPUT "${source}" @ONLY CONTENT
    "#include \"${header}\"\n\n${assembly}\nnamespace ${namespace} {\n${functions}}\n")
  # A source within a unity build would not be compiled again with the files.
  set_source_files_properties("${source}" PROPERTIES OBJECT_DEPENDS "${files}"
    SKIP_UNITY_BUILD_INCLUSION ON)
  set(${variable} "${source}" PARENT_SCOPE)
endfunction()

# spoolwatch_web_assets(variable): the folder with the libraries of the page of `spoolwatch serve`,
# fetched when it is not there; empty, with one line that says why, where they cannot be had.
function(spoolwatch_web_assets variable)
  set(SPOOLWATCH_WEB_ASSETS "${CMAKE_BINARY_DIR}/web_assets" CACHE PATH
    "Libraries of the page of spoolwatch serve (scripts/web-assets FOLDER)")
  if(NOT EXISTS "${SPOOLWATCH_WEB_ASSETS}/uplot.js")
    execute_process(COMMAND "${CMAKE_SOURCE_DIR}/scripts/web-assets" "${SPOOLWATCH_WEB_ASSETS}"
      RESULT_VARIABLE failed ERROR_VARIABLE why OUTPUT_QUIET ERROR_STRIP_TRAILING_WHITESPACE)
    if(failed)
      string(REGEX REPLACE ".*\n" "" why "${why}")
      message(STATUS "The page of spoolwatch serve is left out: ${why}")
      set(${variable} "" PARENT_SCOPE)
      return()
    endif()
  endif()
  set(${variable} "${SPOOLWATCH_WEB_ASSETS}" PARENT_SCOPE)
endfunction()
