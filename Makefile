# Burnish: `make help` lists the targets. Variables: BUILD (folder), ARCH (-march), CFLAGS, PETSC_DIR, PETSC_ARCH,
# PREFIX, SANITIZE, JOBS (number of runs of a study at a time) and V=1 (prints the compile lines).
.DEFAULT_GOAL := all
.DELETE_ON_ERROR:

BUILD  := build
ARCH   := native
CFLAGS := -O3 -g
PREFIX := /usr/local
JOBS   := 2
VENV   := build/venv
ifeq ($(origin CC),default)
  CC := mpicc
endif
# SANITIZE=1 makes a second build, which stops at the first bad address, leak or undefined behaviour.
# `make SANITIZE=1 check` runs the tests with it.
ifdef SANITIZE
  BUILD  := build/sanitize
  CFLAGS := -O1 -g -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=undefined
  LDLIBS = tests/sanitize.c -rdynamic
endif

# One target and what it needs are compiled on all cores, unless -j says how many. Several targets run one after the other.
COMPILED := deps clean all tests
WAITING  := demo check test study bench install
ifeq ($(filter-out $(COMPILED) $(WAITING),$(MAKECMDGOALS))$(word 2,$(filter $(WAITING),$(MAKECMDGOALS))),)
  MAKEFLAGS += -j$(shell env -u OMP_NUM_THREADS nproc 2>/dev/null || echo 1)
endif
Q := $(if $(V),,@)

# PETSc is found by PETSC_DIR and PETSC_ARCH, or else by pkg-config. HDF5 is the one that PETSc was built with.
ifdef PETSC_DIR
  ifeq ($(wildcard $(PETSC_DIR)/$(PETSC_ARCH)/lib/pkgconfig/PETSc.pc $(PETSC_DIR)/lib/pkgconfig/PETSc.pc),)
    $(error PETSC_DIR=$(PETSC_DIR) PETSC_ARCH=$(PETSC_ARCH): no lib/pkgconfig/PETSc.pc there)
  endif
  export PKG_CONFIG_PATH := $(PETSC_DIR)/$(PETSC_ARCH)/lib/pkgconfig:$(PETSC_DIR)/lib/pkgconfig:$(PKG_CONFIG_PATH)
endif
# These are evaluated when they are used, because `make deps all` installs the packages first. Before GNU make 4.4
# $(shell) does not see exported variables, so PKG_CONFIG_PATH is passed on.
PACKAGES      := PETSc yaml-0.1 libcjson muparser
pkgconfig      = $(shell PKG_CONFIG_PATH='$(PKG_CONFIG_PATH)' pkg-config $(1) 2>/dev/null)
petscconf      = $(call pkgconfig,--variable=prefix PETSc)/lib/petsc/conf/petscvariables
petscvariable  = $(shell sed -n 's/^$(1) *= *//p' $(petscconf) 2>/dev/null)

# -fno-math-errno: no code reads errno after a square root. With errno the compiler cannot vectorise square roots.
ALL_CFLAGS := -std=gnu11 -march=$(ARCH) $(CFLAGS) -Wall -Wextra -fno-math-errno
INCLUDES    = -Iinclude -Isrc $(call pkgconfig,--cflags-only-I $(PACKAGES)) $(call petscvariable,HDF5_INCLUDE)
LIBRARIES   = -lmetis $(call pkgconfig,--libs $(PACKAGES)) $(MUMPS) $(call petscvariable,HDF5_LIB) $(call petscvariable,BLASLAPACK_LIB) \
  -Wl,-rpath,$(call pkgconfig,--variable=libdir PETSc) -ldl -lm
# The MUMPS that PETSc was built with, with the flags that PETSc's own link line has for it
PRIVATE     = $(call pkgconfig,--static --libs PETSc)
COMMA      := ,
MUMPS       = $(filter -L%,$(PRIVATE)) $(patsubst -L%,-Wl$(COMMA)-rpath$(COMMA)%,$(filter -L%,$(PRIVATE))) \
  $(foreach flag,$(PRIVATE),$(if $(findstring dmumps,$(flag)),$(flag)))
CMOCKA      = $(call pkgconfig,--libs cmocka)
COMPILE     = $(CC) $(ALL_CFLAGS) $(CPPFLAGS) $(INCLUDES)
LINK        = $(LDFLAGS) $(LIBRARIES) $(LDLIBS)

SOURCES   := $(filter-out src/main.c,$(wildcard src/*/*.c))
OBJECTS   := $(SOURCES:src/%.c=$(BUILD)/obj/%.o)
# Tests may include all private headers. A source finds only those of its own folder.
PRIVATES  := $(patsubst %,-iquote %,$(wildcard src/*/private))
LIBRARY   := $(BUILD)/libburnish.a
BURNISH   := $(BUILD)/burnish
TESTS     := $(patsubst %.c,$(BUILD)/tests/%,$(notdir $(wildcard tests/unit/test_*.c tests/mpi/test_*.c \
  tests/oracle/*.c tests/fuzz/*.c tests/library/*.c)))
BENCHES   := $(patsubst tests/bench/%.c,$(BUILD)/bench/%,$(wildcard tests/bench/*.c))

.PHONY: all tests deps demo check test study bench fuzz valgrind site install help format clean FORCE
all: $(BURNISH) ## builds build/burnish

$(BURNISH): $(BUILD)/obj/main.o $(LIBRARY)
	@echo "link $@"
	$(Q)$(CC) $(ALL_CFLAGS) -o $@ $^ $(LINK)

$(LIBRARY): $(OBJECTS)
	@rm -f $@
	@echo "archive $@"
	$(Q)$(AR) rcs $@ $^

$(BUILD)/obj/%.o: src/%.c $(BUILD)/flags
	@mkdir -p $(@D)
	@echo "compile $<"
	$(Q)$(COMPILE) -iquote $(<D)/private -MMD -MP -c -o $@ $<

tests: $(TESTS) $(BENCHES)

define program # $(1): source folder, $(2): folder of the program
$(2)/%: $(1)/%.c $(LIBRARY) $(BUILD)/flags
	@mkdir -p $$(@D)
	@echo "compile $$<"
	$$(Q)$$(COMPILE) $(PRIVATES) -MMD -MP -o $$@ $$< $(LIBRARY) $$(CMOCKA) $$(LINK)
endef
$(eval $(call program,tests/unit,$(BUILD)/tests))
$(eval $(call program,tests/mpi,$(BUILD)/tests))
$(eval $(call program,tests/oracle,$(BUILD)/tests))
$(eval $(call program,tests/fuzz,$(BUILD)/tests))
$(eval $(call program,tests/bench,$(BUILD)/bench))

# A program that uses the library is compiled with include/ and without src/.
$(BUILD)/tests/%: tests/library/%.c $(LIBRARY) $(BUILD)/flags
	@mkdir -p $(@D)
	@echo "compile $<"
	$(Q)$(CC) $(ALL_CFLAGS) $(CPPFLAGS) -Iinclude $(call pkgconfig,--cflags-only-I PETSc) -MMD -MP -o $@ $< $(LIBRARY) $(LINK)

# Everything is compiled again when the compile or link line changes, for example with another PETSc. Targets that are
# asked for together with deps or clean wait for these, also with make -j.
$(BUILD)/flags: FORCE | $(filter deps clean,$(MAKECMDGOALS))
	@pkg-config --exists $(PACKAGES) 2>/dev/null || \
	  { echo "PETSc, libyaml, cJSON or muParser is missing: run make deps" >&2; exit 1; }
	@mkdir -p $(@D)
	@echo '$(COMPILE) $(LINK)' | cmp -s - $@ || echo '$(COMPILE) $(LINK)' >$@

deps: ## installs or checks everything needed
	@scripts/deps.sh

demo: all ## runs pipe_pinch on 2 ranks: comparison, pictures and a ParaView file in out/
	@[ -x $(VENV)/bin/python ] || { echo "no Python environment in $(VENV): run make deps" >&2; exit 1; }
	@$(VENV)/bin/python scripts/demo.py --burnish $(BURNISH)

check: all tests ## the quick tests
	@scripts/check.sh $(BUILD) -L quick

test: all tests ## all tests
	@scripts/check.sh $(BUILD)

study: all ## accuracy against time: tables and plots in out/study/ (QUICK=1: shows that it runs)
	@[ -x $(VENV)/bin/python ] || { echo "no Python environment in $(VENV): run make deps" >&2; exit 1; }
	@for study in runs/studies/*.args; do \
	  $(VENV)/bin/python scripts/study.py @$$study --burnish $(BURNISH) --jobs $(JOBS) \
	  $(if $(QUICK),--quick --out out/study/quick,--out out/study) || exit 1; done

bench: all tests ## raw timing records, their tables and a plot in out/bench/ (LARGE=1: up to 1e6 unknowns)
	@[ -x $(VENV)/bin/python ] || { echo "no Python environment in $(VENV): run make deps" >&2; exit 1; }
	@scripts/bench.sh $(BUILD)
	@$(VENV)/bin/python scripts/scaling.py --burnish $(BURNISH) $(if $(LARGE),--large) --out out/bench \
	  >out/bench/scaling.txt
	@cat out/bench/scaling.txt
	@$(VENV)/bin/python scripts/physics_table.py --burnish $(BURNISH) --out out/bench/physics \
	  --record out/bench/physics.csv >out/bench/physics.txt
	@cat out/bench/physics.txt

fuzz: ## looks for files that break the readers, SECONDS=600 for each, with clang
	@scripts/fuzz.sh $(or $(SECONDS),600)

valgrind: ## runs the unit tests of the plain C kernels under valgrind
	@scripts/valgrind.sh

site: ## builds the documentation with search in out/site; warnings are errors
	@[ -x $(VENV)/bin/mkdocs ] || { echo "no MkDocs in $(VENV): run make deps" >&2; exit 1; }
	@PYTHONDONTWRITEBYTECODE=1 $(VENV)/bin/mkdocs --quiet build --strict -f doc/mkdocs.yml -d $(CURDIR)/out/site

install: all ## installs program, library, pages and examples into PREFIX (default /usr/local)
	install -D -m 755 $(BURNISH) $(DESTDIR)$(PREFIX)/bin/burnish
	install -D -m 644 include/burnish.h $(DESTDIR)$(PREFIX)/include/burnish.h
	install -D -m 644 $(LIBRARY) $(DESTDIR)$(PREFIX)/lib/libburnish.a
	$(file >$(BUILD)/burnish.pc,$(PKGCONFIG_FILE))install -D -m 644 $(BUILD)/burnish.pc \
	  $(DESTDIR)$(PREFIX)/lib/pkgconfig/burnish.pc
	install -D -m 644 doc/burnish.1 $(DESTDIR)$(PREFIX)/share/man/man1/burnish.1
	install -D -m 644 doc/burnish.bash $(DESTDIR)$(PREFIX)/share/bash-completion/completions/burnish
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/doc/burnish README.md
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/doc/burnish/doc/pages $(wildcard doc/pages/*.md)
	for picture in $(wildcard runs/records/*.png runs/records/*/*.png); do \
	  install -D -m 644 $$picture $(DESTDIR)$(PREFIX)/share/doc/burnish/$$picture || exit 1; done
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/burnish/scripts $(wildcard scripts/*.py) \
	  scripts/requirements.txt scripts/pyproject.toml
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/burnish/scripts/burnish $(wildcard scripts/burnish/*.py)
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/burnish/scripts/meshfiles $(wildcard scripts/meshfiles/*.py)
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/burnish/runs $(wildcard runs/*.yaml)
	install -D -m 644 -t $(DESTDIR)$(PREFIX)/share/burnish/meshes $(wildcard meshes/*.geo meshes/*.step)

# The library is static, so that a program that links it also links the libraries that it calls.
define PKGCONFIG_FILE
prefix=$(PREFIX)

Name: burnish
Description: Contact of deformable bodies, from a scene file to results, in parallel
Version: $(shell sed -n 's/.*BURNISH_VERSION "\(.*\)"/\1/p' src/scene/commandline.h)
Cflags: -I$${prefix}/include $(call pkgconfig,--cflags-only-I PETSc)
Libs: -L$${prefix}/lib -lburnish $(strip $(LIBRARIES)) $(filter -fsanitize%,$(CFLAGS))
endef

help: ## this list
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/make \1\t\2/p' Makefile | expand -t 16

format: ## formats the C sources
	$(VENV)/bin/clang-format -i $(wildcard include/*.h src/*.c src/*/*.[ch] src/*/private/*.h tests/*.h tests/*/*.[ch])

clean: ## removes what was built (out/ and the Python environment stay)
	rm -rf $(BUILD)/obj $(BUILD)/tests $(BUILD)/bench $(BUILD)/ctest $(BUILD)/flags $(BUILD)/burnish.pc \
	  $(LIBRARY) $(BURNISH)

-include $(wildcard $(BUILD)/obj/*.d $(BUILD)/obj/*/*.d $(BUILD)/tests/*.d $(BUILD)/bench/*.d)
