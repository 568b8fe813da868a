# impactcheck with FEniCSx, gmsh and what they need: models, references and reports in one image.
#
#   docker build --tag impactcheck .
#   docker run --rm --user "$(id -u)" --volume "$PWD:/work" impactcheck gate my-impact.toml --compute
#   docker run --rm --user "$(id -u)" --volume "$PWD:/work" --entrypoint python3 impactcheck my-script.py   # import impactcheck
# FEniCSx's wheels are for x86-64: with `--platform linux/amd64` the image is built and runs on Apple silicon too.
FROM rust:1.89-bookworm AS build
WORKDIR /source
COPY . .
# the Python package's extension finds the symbols of the interpreter that loads it
RUN PYO3_BUILD_EXTENSION_MODULE=1 cargo build --release --locked --package impactcheck --package impactcheck-python \
    && strip target/release/impactcheck target/release/lib_core.so

FROM python:3.12-slim-bookworm
# a compiler for kernels, CalculiX, and the libraries that gmsh's wheel takes from the system
# hadolint ignore=DL3008
RUN apt-get update \
    && DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends \
        calculix-ccx gcc libc6-dev libgl1 libglu1-mesa libxcursor1 libxft2 libxinerama1 \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /source/target/release/impactcheck /usr/local/bin/
WORKDIR /setup
COPY --from=build /source/pyproject.toml .
# what the extra [reference] lists
RUN python3 -c 'import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"]["reference"], sep="\n")' > reference.txt \
    && pip install --no-cache-dir --requirement reference.txt
COPY python/impactcheck /usr/local/lib/python3.12/site-packages/impactcheck
COPY --from=build /source/target/release/lib_core.so /usr/local/lib/python3.12/site-packages/impactcheck/_core.abi3.so
COPY scenes /usr/local/share/impactcheck/scenes
COPY meshes /usr/local/share/impactcheck/meshes
COPY fem_reference /usr/local/share/impactcheck/fem_reference
# whoever runs it writes into the folder mounted here; what it computes besides goes to /data
RUN useradd --create-home --uid 1000 impactcheck && install --directory --mode 1777 /data /work
ENV XDG_DATA_HOME=/data XDG_CACHE_HOME=/data/cache PYTHONDONTWRITEBYTECODE=1
USER 1000
WORKDIR /work
ENTRYPOINT ["impactcheck"]
CMD ["--help"]
