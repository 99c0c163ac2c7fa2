# An agent in a container: Debian packages are built in the first stage and installed in the second.
#   docker build -t galatea .
#   docker run --rm -it --network host galatea --web            # prints the page's address
#   docker run --rm -v "$PWD:/films" galatea --say "Hello." --out /films/hello.mp4
FROM debian:12-slim AS build
COPY . /galatea
WORKDIR /galatea
# dpkg-dev and file find out what the packages need. Without GoogleTest no tests are built.
RUN apt-get update && apt-get install -y --no-install-recommends dpkg-dev file && \
    scripts/setup.sh && CC=gcc CXX=g++ scripts/build.sh && cd build && cpack

FROM debian:12-slim
COPY --from=build /galatea/build/galatea_*.deb /tmp/
RUN apt-get update && apt-get install -y /tmp/galatea_*.deb && rm -rf /tmp/*.deb /var/lib/apt/lists/*
WORKDIR /films
ENTRYPOINT ["galatea-agent"]
CMD ["--web"]
