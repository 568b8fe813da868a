# impactcheck with FEniCSx, gmsh and what they need: models, references and reports in one image.
#
#   docker build --tag impactcheck .
#   docker run --rm --user "$(id -u)" --volume "$PWD:/work" impactcheck gate my-impact.toml --compute
#   docker run --rm --user "$(id -u)" --volume "$PWD:/work" --entrypoint python3 impactcheck my-script.py   # import impactcheck
FROM rust:1.89-bookworm AS build
WORKDIR /source
COPY . .
# the Python package's extension finds the symbols of the interpreter that loads it
RUN PYO3_BUILD_EXTENSION_MODULE=1 cargo build --release --locked --package impactcheck --package impactcheck-python \
    && strip target/release/impactcheck target/release/lib_core.so

FROM debian:bookworm-slim
# a release of Debian fixes the versions: results are those of its FEniCSx 0.5.2
# hadolint ignore=DL3008
RUN apt-get update \
    && DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends \
        calculix-ccx gcc libc6-dev openmpi-bin python3-cffi python3-dolfinx python3-gmsh python3-meshio \
    && rm -rf /var/lib/apt/lists/*
COPY --from=build /source/target/release/impactcheck /usr/local/bin/
COPY python/impactcheck /usr/local/lib/python3.11/dist-packages/impactcheck
COPY --from=build /source/target/release/lib_core.so /usr/local/lib/python3.11/dist-packages/impactcheck/_core.abi3.so
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
