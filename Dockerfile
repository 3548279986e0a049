# One image for the API, the workers and the migrations; docker-compose.yml names their commands.
FROM python:3.11-slim-bookworm AS build

# This stage compiles the engine's kernels, so the final image needs no compiler.
RUN apt-get update && apt-get install --yes --no-install-recommends gcc libc6-dev
WORKDIR /source
COPY pyproject.toml setup.py README.md ./
COPY engine engine
COPY app app
COPY worker worker
COPY migrations migrations
RUN pip wheel --no-cache-dir --no-deps --wheel-dir /wheels .

FROM python:3.11-slim-bookworm

# One BLAS thread: BLAS threads and forked workers can deadlock, and one process a core is faster here.
ENV OPENBLAS_NUM_THREADS=1 \
    OMP_NUM_THREADS=1 \
    MKL_NUM_THREADS=1 \
    PYTHONUNBUFFERED=1 \
    PYTHONDONTWRITEBYTECODE=1 \
    GALLOPING_DATA_DIR=/data

# For Chinese, Japanese and Korean names on pictures; see docs/operation.md.
RUN apt-get update && apt-get install --yes --no-install-recommends fonts-wqy-microhei && rm -rf /var/lib/apt/lists/*

RUN useradd --system --uid 10001 --home-dir /data --create-home galloping

WORKDIR /opt/galloping
COPY constraints.txt ./
COPY --from=build /wheels /wheels
RUN pip install --no-cache-dir --constraint constraints.txt "$(echo /wheels/*.whl)[all]"

USER galloping
WORKDIR /data
VOLUME /data
EXPOSE 8000
CMD ["galloping", "serve", "--host", "0.0.0.0", "--port", "8000"]
