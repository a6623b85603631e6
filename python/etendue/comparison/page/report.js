"use strict";
// The viewer: images unpacked, errors computed, two flip books side by side that move together.
(async () => {
    const data = JSON.parse(document.getElementById("data").textContent);
    const { width, height, estimators } = data;
    const pixels = width * height;

    // The inverse of packing.py.
    async function unpack(image) {
        const packed = await (await fetch("data:;base64," + image.data)).blob();
        const stream = packed.stream().pipeThrough(new DecompressionStream("deflate"));
        const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
        const count = pixels * image.channels;
        const bits = new Uint16Array(count);
        for (let i = 0; i < count; ++i) bits[i] = bytes[i] | (bytes[count + i] << 8);
        if (image.channels === 3) {
            for (let i = 0; i < pixels; ++i) {
                bits[i] += bits[pixels + i];
                bits[2 * pixels + i] += bits[pixels + i];
            }
        }
        const values = new Float32Array(count);
        for (let channel = 0; channel < image.channels; ++channel) {
            for (let i = 0; i < pixels; ++i) {
                values[i * image.channels + channel] = half(bits[channel * pixels + i] << image.dropped) * image.scale;
            }
        }
        return values;
    }

    function half(bits) {
        const exponent = (bits >> 10) & 31, mantissa = bits & 1023;
        const value = exponent ? 2 ** (exponent - 15) * (1 + mantissa / 1024) : 2 ** -24 * mantissa;
        return bits & 0x8000 ? -value : value;
    }

    function perPixel(of) {
        const values = new Float32Array(pixels);
        for (let i = 0; i < pixels; ++i) {
            let sum = 0;
            for (let j = 3 * i; j < 3 * i + 3; ++j) sum += of(j);
            values[i] = sum / 3;
        }
        return values;
    }

    const reference = await unpack(data.reference);
    for (const each of estimators) {
        for (const name of ["image", "variance", "samples", "flip"]) each[name] = await unpack(each[name]);
        const weight = (j) => reference[j] * reference[j] + data.epsilon;
        each.error = perPixel((j) => (each.image[j] - reference[j]) ** 2 / weight(j));
        each.signed = perPixel((j) => (each.image[j] - reference[j]) / Math.sqrt(weight(j)));
        for (let i = 0; i < pixels; ++i) each.flip[i] /= 100;
    }

    const logarithmic = (low, high) =>
        `rgb = infernoMap(${low.toFixed(4)}, ${high.toFixed(4)}, log(max(rgb.x, 1e-30)) / log(10.0));`;
    const top = Math.log10(Math.max(...estimators.map((each) => each.variance_top)));
    const most = Math.max(...estimators.map((each) => each.samples_top));
    const METRICS = {
        error: ["Error", logarithmic(-4, 1), "(I − R)² / (R² + 0.01), logarithmic, from 0.0001 (black) to 10 (yellow)."],
        signed: [
            "Signed error",
            "float v = clamp(rgb.x, -1.0, 1.0); rgb = mix(vec3(1.0), v > 0.0 ? vec3(0.6, 0.02, 0.02) : vec3(0.02, 0.1, 0.6), abs(v));",
            "(I − R) / √(R² + 0.01): red is too bright, blue too dark, fully from ±1.",
        ],
        variance: ["Variance", logarithmic(top - 5, top), "Variance of one sample, from all repeats, logarithmic over five decades."],
        samples: ["Samples", `rgb = infernoMap(0.0, ${(most * 1.1).toFixed(2)}, rgb.x);`, `Samples of the pixel, from 0 to ${most}.`],
        flip: ["FLIP", "rgb = infernoMap(0.0, 1.0, rgb.x);", "FLIP: from 0, no difference to see (black), to 1 (yellow)."],
    };

    const pixelLine = document.getElementById("pixel");
    function tell(x, y) {
        const i = y * width + x;
        const text = (values) => Array.from(values.subarray(3 * i, 3 * i + 3), (v) => v.toPrecision(3)).join(" ");
        const parts = [`pixel ${x}, ${y}`, `reference: ${text(reference)}`];
        for (const each of estimators) parts.push(`${each.name}: ${text(each.image)} (error ${each.error[i].toPrecision(3)})`);
        pixelLine.replaceChildren(...parts.map((part) => Object.assign(document.createElement("span"), { textContent: part })));
    }

    async function book(parent, id, names, images, settings, alone) {
        const container = Object.assign(document.createElement("div"), { id });
        document.getElementById(parent).append(container);
        await flipbook.MakeFlipBook(
            {
                containerId: id,
                id,
                names,
                width,
                height,
                dataUrls: images,
                types: images.map(() => "float32array"),
                initialZoom: -1,
                initialTMO: settings,
                // Keys change the exposure of all books, but for images with settings of their own.
                initialTMOOverrides: alone ? images.map(() => settings) : undefined,
                groupName: "report",
                hideTools: true,
                colorTheme: "dark",
            },
            undefined, undefined, tell,
        );
        return container;
    }

    const names = estimators.map((each) => each.name);
    const containers = {};
    for (const [metric, [, script]] of Object.entries(METRICS)) {
        const images = estimators.map((each) => each[metric]);
        containers[metric] = await book("metric", `book-${metric}`, names, images, { activeTMO: "script", script }, true);
    }
    const exposure = { activeTMO: "exposure", exposure: Math.log2(data.exposure) };
    await book("beauty", "book-beauty", [...names, "reference"], [...estimators.map((each) => each.image), reference], exposure);

    const buttons = {};
    function choose(chosen) {
        for (const [metric, container] of Object.entries(containers)) {
            container.classList.toggle("behind", metric !== chosen);
            buttons[metric].setAttribute("aria-pressed", metric === chosen);
        }
        document.getElementById("legend").textContent = METRICS[chosen][2];
    }
    for (const [metric, [label]] of Object.entries(METRICS)) {
        buttons[metric] = Object.assign(document.createElement("button"), { type: "button", textContent: label });
        buttons[metric].addEventListener("click", () => choose(metric));
    }
    document.querySelector(".metrics").append(...Object.values(buttons));
    choose("error");
    document.body.dataset.ready = "yes";
})().catch((error) => {
    document.getElementById("pixel").textContent = `The images cannot be shown here: ${error}`;
    throw error;
});
