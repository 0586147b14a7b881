// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job type for Flamenco (https://flamenco.blender.org): runs a STIV job file on a render farm, in parts.
// Put this file into the folder `scripts` beside flamenco-manager. docs/batch.md says more.

const JOB_TYPE = {
    label: "STIV Batch",
    description: "Run a job of `stiv batch` over many scenes, each part of it as a task",
    settings: [
        { key: "job_file", type: "string", subtype: "file_path", required: true,
          description: "The STIV job, at a path that all workers see" },
        { key: "parts", type: "int32", default: 8,
          description: "Number of tasks; each runs an equal share of the scenes" },
        { key: "workers", type: "int32", default: 1,
          description: "Worker processes of each task" },
        { key: "stiv", type: "string", default: "stiv", visible: "submission",
          description: "The program to run; may be a variable of Flamenco's, such as {stiv}" },
        { key: "blender", type: "string", default: "", visible: "submission",
          description: "Installed Blender to use, such as {blender}; empty for Blender as a Python module" },
    ]
};

function compileJob(job) {
    const settings = job.settings;
    const parts = settings.parts;
    if (!settings.job_file) {
        throw new Error("job_file: which STIV job shall be run?");
    }
    if (!(parts >= 1 && parts <= 999999)) {
        throw new Error("parts: " + parts + " is not between 1 and 999999");
    }
    if (!(settings.workers >= 1 && settings.workers <= 1024)) {
        throw new Error("workers: " + settings.workers + " is not between 1 and 1024");
    }
    for (var part = 1; part <= parts; part++) {
        job.addTask(partTask(settings, part, parts));
    }
}

// `--resume`: a task that Flamenco repeats continues where it ended.
function partTask(settings, part, parts) {
    var args = ["batch", settings.job_file, "--resume", "--part", part + "/" + parts, "--workers", "" + settings.workers];
    if (settings.blender) {
        args = args.concat(["--blender", settings.blender]);
    }
    const task = author.Task("scenes-" + part + "-of-" + parts, "blender");
    task.addCommand(author.Command("exec", { exe: settings.stiv, args: args }));
    return task;
}
