//! Shards as indexed jobs of Kubernetes: a manifest to be applied, nothing that watches it.
//!
//! One job for each level; the second is applied when the first is done. Must not know: any cluster.

use std::path::Path;

use super::super::Ending;
use super::super::progress::out;
use studygraph::runner::shard::ShardPlan;
use studygraph::store::file::{self, Durability};

/// Writes `job.yaml` beside the plan.
///
/// # Errors
/// When it cannot be written.
pub fn write(plan: &ShardPlan, folder: &Path, image: &str, quiet: bool) -> Result<(), Ending> {
    let path = folder.join("job.yaml");
    let short = &plan.digest[..12];
    let mut text = String::from(
        "# Indexed jobs for the shards of plan.json. The claim `gearstudy` must hold this folder as /plan.\n\
         # One job for each level: apply the next when the one before is complete, then `gearstudy shard merge`.\n",
    );
    for (number, level) in plan.levels.iter().enumerate() {
        text += &format!(
            "---\n\
             apiVersion: batch/v1\n\
             kind: Job\n\
             metadata: {{ name: gearstudy-{short}-{number} }}\n\
             spec:\n\
             \x20 completionMode: Indexed\n\
             \x20 completions: {completions}\n\
             \x20 parallelism: {completions}\n\
             \x20 backoffLimitPerIndex: 3\n\
             \x20 maxFailedIndexes: {completions}\n\
             \x20 template:\n\
             \x20   spec:\n\
             \x20     restartPolicy: Never\n\
             \x20     containers:\n\
             \x20       - name: shard\n\
             \x20         image: {image}\n\
             \x20         command: [sh, -c, \"exec gearstudy shard run /plan $(({first} + JOB_COMPLETION_INDEX)) --jobs 1\"]\n\
             \x20         resources: {{ requests: {{ cpu: \"1\" }} }}\n\
             \x20         volumeMounts: [{{ name: plan, mountPath: /plan }}]\n\
             \x20     volumes:\n\
             \x20       - name: plan\n\
             \x20         persistentVolumeClaim: {{ claimName: gearstudy }}\n",
            completions = level.end - level.first,
            first = level.first,
            image = serde_json::Value::from(image),
        );
    }
    file::write(&path, text.as_bytes(), Durability::Lazy).map_err(|error| Ending::Usage(error.to_string()))?;
    if !quiet {
        out(&format!("wrote {}\n", path.display()));
    }
    Ok(())
}
