"""A series of twelve DICOM images: a test image of pydicom with a white bar that is longer from image to image, so that a
picture of the screen tells which of them is shown: `python3 tools/apps/series.py FOLDER`. Compressed images of pydicom are
beside them, in `FOLDER/compressed`.
"""
import os
import shutil
import sys

import numpy
import pydicom
from pydicom.data import get_testdata_file
from pydicom.uid import generate_uid

IMAGES = 12
# Pixels by which the bar is longer in the next image.
STEP = 9


def write(folder):
    """Writes the series; returns the names of its files in their order."""
    names = []
    for number in range(1, IMAGES + 1):
        image = pydicom.dcmread(get_testdata_file("CT_small.dcm"))
        pixels = image.pixel_array.astype(numpy.int16)
        pixels[8:16, 4:4 + STEP * number] = pixels.max()
        image.PixelData = pixels.tobytes()
        image.SeriesInstanceUID = generate_uid(entropy_srcs=["underfoot", "series"])
        image.SOPInstanceUID = generate_uid(entropy_srcs=["underfoot", str(number)])
        image.file_meta.MediaStorageSOPInstanceUID = image.SOPInstanceUID
        image.InstanceNumber = number
        names.append(os.path.join(folder, f"{number:02}.dcm"))
        image.save_as(names[-1])
    return names


def copy_compressed(folder):
    """Copies images in JPEG 2000 and JPEG-LS."""
    os.makedirs(folder)
    for name in ("MR_small_jp2klossless.dcm", "MR_small_jpeg_ls_lossless.dcm"):
        shutil.copy(get_testdata_file(name), folder)


if __name__ == "__main__":
    os.makedirs(sys.argv[1], exist_ok=True)
    write(sys.argv[1])
    copy_compressed(os.path.join(sys.argv[1], "compressed"))
