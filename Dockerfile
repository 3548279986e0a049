# One image for the API, the workers and the migrations; docker-compose.yml names their commands.
FROM python:3.11-slim-bookworm AS build

# This stage compiles the engine's kernels and fills the environment, so the final image needs neither compiler nor pip.
RUN apt-get update && apt-get install --yes --no-install-recommends gcc libc6-dev
WORKDIR /source
COPY pyproject.toml setup.py README.md constraints.txt ./
RUN python -m venv /opt/galloping && python -m venv /opt/audit \
    && /opt/audit/bin/pip install --no-cache-dir --constraint constraints.txt cyclonedx-bom
COPY engine engine
COPY app app
COPY worker worker
COPY migrations migrations
RUN /opt/galloping/bin/pip install --no-cache-dir --constraint constraints.txt '.[all]' \
    && /opt/galloping/bin/pip uninstall --yes pip
# What the image holds, by name, version and licence: for those who must say what they run.
RUN /opt/audit/bin/cyclonedx-py environment --output-reproducible --output-file /opt/galloping/sbom.cdx.json \
    /opt/galloping/bin/python

FROM python:3.11-slim-bookworm

LABEL org.opencontainers.image.title="galloping" \
      org.opencontainers.image.description="Tells whether an iced transmission-line span gallops" \
      org.opencontainers.image.version="0.5.0" \
      org.opencontainers.image.base.name="python:3.11-slim-bookworm"

# One BLAS thread: BLAS threads and forked workers can deadlock, and one process a core is faster here.
ENV OPENBLAS_NUM_THREADS=1 \
    OMP_NUM_THREADS=1 \
    MKL_NUM_THREADS=1 \
    PYTHONUNBUFFERED=1 \
    PYTHONDONTWRITEBYTECODE=1 \
    PATH=/opt/galloping/bin:$PATH \
    GALLOPING_DATA_DIR=/data

# For Chinese, Japanese and Korean names on pictures; see docs/operation.md.
RUN apt-get update && apt-get install --yes --no-install-recommends fonts-wqy-microhei && rm -rf /var/lib/apt/lists/*

RUN useradd --system --uid 10001 --home-dir /data --create-home galloping

COPY --from=build /opt/galloping /opt/galloping

USER galloping
WORKDIR /data
VOLUME /data
EXPOSE 8000
# Of an API; docker-compose.yml has another one for workers.
HEALTHCHECK --interval=10s --timeout=5s --start-period=30s --retries=3 \
    CMD ["python", "-c", "import urllib.request; urllib.request.urlopen('http://127.0.0.1:8000/health/ready', timeout=3)"]
CMD ["galloping", "serve", "--host", "0.0.0.0", "--port", "8000"]
