# What is installed, and the Debian package (cpack): programs, unit, udev rule, user, configurations,
# models, message types, man pages and completion.
include(GNUInstallDirs)
find_package(Python3 REQUIRED COMPONENTS Interpreter)

set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
set(share "${CMAKE_INSTALL_DATADIR}/spoolwatch")
set(made "${CMAKE_BINARY_DIR}/packaging")
file(MAKE_DIRECTORY "${made}")

# What is missing is built first: cpack does not, and scripts/demo builds only a part.
install(CODE "
  execute_process(COMMAND \"${CMAKE_COMMAND}\" --build \"${CMAKE_BINARY_DIR}\" --target pages
    COMMAND_ERROR_IS_FATAL ANY)")

# Man pages and completion, from what the programs say of themselves.
set(pages "${CMAKE_SOURCE_DIR}/systemd/package/pages")
function(spoolwatch_page output depends)
  add_custom_command(OUTPUT "${made}/${output}"
    COMMAND sh -c "\"$@\" > '${made}/${output}.part' && mv '${made}/${output}.part' '${made}/${output}'"
      sh "${Python3_EXECUTABLE}" "${pages}" ${ARGN}
    DEPENDS "${pages}" "${CMAKE_SOURCE_DIR}/systemd/package/help_text.py" ${depends} VERBATIM)
endfunction()
set(programs spoolwatchd spoolwatch spoolwatch-rig)
set(package "${CMAKE_SOURCE_DIR}/systemd/package")
set(tool $<TARGET_FILE:spoolwatch>)
# A page for each program, each group of commands and each file format; NAME.SECTION.roff adds to it.
set(outputs "")
function(spoolwatch_man name section depends)
  set(extra "${package}/${name}.${section}.roff")
  spoolwatch_page(${name}.${section} "${depends};${extra}" ${ARGN} ${PROJECT_VERSION} "${extra}")
  install(FILES "${made}/${name}.${section}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man${section}")
  list(APPEND outputs "${made}/${name}.${section}")
  set(outputs "${outputs}" PARENT_SCOPE)
endfunction()
spoolwatch_man(spoolwatchd 8 spoolwatchd man $<TARGET_FILE:spoolwatchd> 8)
spoolwatch_man(spoolwatch 1 spoolwatch man ${tool} 1)
spoolwatch_man(spoolwatch-rig 1 spoolwatch-rig man $<TARGET_FILE:spoolwatch-rig> 1)
foreach(group model data detection stand exchange)
  spoolwatch_man(spoolwatch-${group} 1 spoolwatch group ${tool} ${group})
endforeach()
foreach(format record model)
  spoolwatch_man(spoolwatch-${format} 5 "" format spoolwatch-${format} 5)
endforeach()
spoolwatch_page(completion "${programs}" bash
  $<TARGET_FILE:spoolwatch> $<TARGET_FILE:spoolwatchd> $<TARGET_FILE:spoolwatch-rig>)
add_custom_target(pages ALL DEPENDS ${outputs} "${made}/completion")
foreach(program IN LISTS programs)
  install(FILES "${made}/completion" RENAME ${program}
    DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
endforeach()
install(TARGETS ${programs} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")

# The service. Its configuration finds the models where the package puts them.
install(FILES systemd/spoolwatchd.service systemd/spoolwatch-serve.service
  systemd/spoolwatch-serve.socket DESTINATION lib/systemd/system)
install(FILES systemd/spoolwatch.sysusers DESTINATION lib/sysusers.d RENAME spoolwatch.conf)
install(FILES systemd/60-spoolwatch.rules DESTINATION lib/udev/rules.d)
file(READ config/spoolwatchd.toml text)
string(REPLACE "model = \"models/" "model = \"/usr/${share}/models/" text "${text}")
string(REPLACE "group = \"\"  " "group = \"spoolwatch\"  " text "${text}")
if(NOT text MATCHES "model = \"/usr/" OR NOT text MATCHES "group = \"spoolwatch\"")
  message(FATAL_ERROR "config/spoolwatchd.toml: model and group are not where the package sets them")
endif()
file(CONFIGURE OUTPUT "${made}/spoolwatchd.toml" CONTENT "${text}" @ONLY)
install(FILES "${made}/spoolwatchd.toml" DESTINATION /etc/spoolwatch)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS config/spoolwatchd.toml)

# Samples: every configuration with its models beside it, and the message types.
file(GLOB configurations CONFIGURE_DEPENDS config/*.toml)
install(FILES ${configurations} DESTINATION "${share}")
install(DIRECTORY config/models config/scorecard config/tour DESTINATION "${share}")
install(FILES config/messages/spoolwatch.lcm DESTINATION "${share}/messages")
# The pages with their pictures, laid out as in the repository so that their links hold.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY docs DESTINATION "${CMAKE_INSTALL_DOCDIR}"
  FILES_MATCHING PATTERN "*.md" PATTERN "*.schema.json")
install(DIRECTORY examples DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(FILES scripts/tour.png scripts/demo.png DESTINATION "${CMAKE_INSTALL_DOCDIR}/scripts")
install(FILES systemd/package/copyright DESTINATION "${CMAKE_INSTALL_DOCDIR}")

# Compressed as Debian wants it, the same bytes from the same input.
install(CODE "
  file(GLOB texts \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man*/*[158]\")
  set(log \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}/changelog\")
  file(WRITE \"\${log}\" \"spoolwatch (${PROJECT_VERSION}) stable; urgency=medium\\n\\n\"
    \"  * Version ${PROJECT_VERSION}: see CHANGELOG.md.\\n\\n\"
    \" -- The Spoolwatch authors <maintainers@example.org>  Thu, 01 Jan 2026 00:00:00 +0000\\n\")
  execute_process(COMMAND gzip -9nf \${texts} \"\${log}\" COMMAND_ERROR_IS_FATAL ANY)")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME spoolwatch)
set(CPACK_PACKAGE_CONTACT "The Spoolwatch authors <maintainers@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Servo-hydraulic test stand control and fault detection")
set(CPACK_PACKAGE_DESCRIPTION "A 200 Hz control loop as a service with fault detection and alarms over LCM,
and a tool that finds what the model of a stand misses. Backends: simulation,
Modbus TCP and RTU, quadrature encoders on GPIO, comedi boards.")
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "systemd | systemd-standalone-sysusers")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "bash-completion")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
file(WRITE "${made}/conffiles" "/etc/spoolwatch/spoolwatchd.toml\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${made}/conffiles"
  "${CMAKE_SOURCE_DIR}/systemd/package/postinst" "${CMAKE_SOURCE_DIR}/systemd/package/prerm"
  "${CMAKE_SOURCE_DIR}/systemd/package/postrm")
include(CPack)
