#!/bin/sh
# Takes everything and answers nothing.
exec sleep 1000
