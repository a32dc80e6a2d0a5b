// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Disparities are whole numbers of sixteenths of a pixel.

export const scale = 16;

export const inPixels = (value, digits = 1) => (value / scale).toFixed(digits);

// The smallest and the largest one, and how many there are not
export function rangeOf(disparity, invalid) {
    let smallest = Infinity,
        largest = -Infinity,
        rejected = 0;
    for (const value of disparity)
        if (value === invalid) {
            rejected++;
        } else {
            smallest = Math.min(smallest, value);
            largest = Math.max(largest, value);
        }
    return rejected === disparity.length ? { smallest: 0, largest: 0, rejected } : { smallest, largest, rejected };
}
